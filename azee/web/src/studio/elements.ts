// Elements made in one expression.

type Attributes = Record<string, string | number | boolean | null | ((event: Event) => void)>;

/** Makes an element: functions listen to events (`onclick`), true and false set flags. */
export function h<Name extends keyof HTMLElementTagNameMap>(
  name: Name, attributes: Attributes = {}, ...children: (Node | string | null)[]
): HTMLElementTagNameMap[Name] {
  const element = document.createElement(name);
  dress(element, attributes);
  element.append(...children.filter(child => child !== null));
  return element;
}

/** Makes an element of a drawing. */
export function svg<Name extends keyof SVGElementTagNameMap>(
  name: Name, attributes: Attributes = {}, ...children: (Node | string)[]
): SVGElementTagNameMap[Name] {
  const element = document.createElementNS('http://www.w3.org/2000/svg', name);
  dress(element, attributes);
  element.append(...children);
  return element;
}

function dress(element: Element, attributes: Attributes): void {
  for (const [key, value] of Object.entries(attributes)) {
    if (typeof value === 'function') element.addEventListener(key.slice(2), value);
    else if (value === true) element.setAttribute(key, '');
    else if (value !== false && value !== null) element.setAttribute(key, String(value));
  }
}

/** Makes a drop-down list; `choices` are values and what people read. */
export function choice(
  label: string, choices: readonly (readonly [string, string])[], value: string,
  changed: (value: string) => void,
): HTMLSelectElement {
  const list = h('select', { 'aria-label': label },
    ...choices.map(([key, text]) => h('option', { value: key }, text)));
  list.value = value;
  list.addEventListener('change', () => changed(list.value));
  return list;
}
