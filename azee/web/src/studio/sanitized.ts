// What the language server says as HTML: plain words only.

const ALLOWED = new Set([
  'P', 'UL', 'OL', 'LI', 'CODE', 'PRE', 'EM', 'STRONG', 'B', 'I', 'BR', 'SPAN', 'HR', 'H1', 'H2',
  'H3', 'H4', 'BLOCKQUOTE', 'DIV',
]);

/** Returns HTML in which only plain elements are left, with no attribute but CodeMirror's classes. */
export function sanitized(html: string): string {
  const parsed = new DOMParser().parseFromString(html, 'text/html');
  for (const element of [...parsed.body.querySelectorAll('*')]) {
    if (!ALLOWED.has(element.tagName)) {
      element.replaceWith(element.textContent ?? '');
      continue;
    }
    for (const { name } of [...element.attributes])
      if (name !== 'class') element.removeAttribute(name);
  }
  return parsed.body.innerHTML;
}
