// node textmate.mjs GRAMMAR.json TEXTS.json: the tokens that editors see in each text, as JSON:
// per text a list of [line, start, end, scope], columns in UTF-16 code units.
import fs from 'node:fs';
import { createRequire } from 'node:module';
import textmate from 'vscode-textmate';
import oniguruma from 'vscode-oniguruma';

const [grammarFile, textsFile] = process.argv.slice(2);
const engine = createRequire(import.meta.url).resolve('vscode-oniguruma/release/onig.wasm');
await oniguruma.loadWASM(fs.readFileSync(engine));
const registry = new textmate.Registry({
  onigLib: Promise.resolve({
    createOnigScanner: (patterns) => new oniguruma.OnigScanner(patterns),
    createOnigString: (text) => new oniguruma.OnigString(text),
  }),
  loadGrammar: async () =>
    textmate.parseRawGrammar(fs.readFileSync(grammarFile, 'utf8'), grammarFile),
});
const grammar = await registry.loadGrammar('source.azee');

const read = (text) => {
  let state = textmate.INITIAL;
  return text.split(/\r\n|\r|\n/).flatMap((line, number) => {
    const { tokens, ruleStack } = grammar.tokenizeLine(line, state);
    state = ruleStack;
    return tokens
      .filter((token) => token.scopes.length > 1)
      .map((token) => [number, token.startIndex, token.endIndex, token.scopes.at(-1)]);
  });
};
console.log(JSON.stringify(JSON.parse(fs.readFileSync(textsFile, 'utf8')).map(read)));
