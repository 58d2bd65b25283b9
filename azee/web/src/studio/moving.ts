// A server that was started again has another address: the page goes there with what was typed.
// The text goes in the fragment of the address, which browsers send to nobody.

const ADDRESS = /^http:\/\/(127\.0\.0\.1|localhost):\d{1,5}\/[\w-]{16,}\/$/;
const TYPED = '#typed=';

/** Returns an address of a studio of this machine, as `azee studio` prints it, else null. */
export function studioAddress(given: string): string | null {
  const address = given.trim();
  return ADDRESS.test(address) ? address : null;
}

/** Goes to a studio with the text of a file. */
export function goTo(address: string, file: string, text: string): void {
  const there = new URL(address);
  there.search = location.search;
  there.searchParams.set('file', file);
  there.hash = `${TYPED}${encodeURIComponent(text)}`;
  location.assign(there);
}

/** Returns the text that was brought along, once; null where there is none. */
export function broughtAlong(): string | null {
  if (!location.hash.startsWith(TYPED)) return null;
  const text = location.hash.slice(TYPED.length);
  history.replaceState(null, '', location.pathname + location.search);
  try {
    return decodeURIComponent(text);
  } catch {
    return null; // somebody has cut the address
  }
}
