// The colours of AZee's words. The language server knows more; this needs no answer of it.
import { HighlightStyle, StreamLanguage, syntaxHighlighting } from '@codemirror/language';
import { Tag, tags } from '@lezer/highlight';

const bone = Tag.define(), site = Tag.define(), rule = Tag.define(), block = Tag.define();

const WORDS: readonly (readonly [RegExp, string])[] = [
  [/^#.*/, 'comment'],
  [/^"(?:[^"\\]|\\.)*"?/, 'string'],
  [/^[:.](?:#?)[^\s(),'"#:^@!]+/u, 'rule'],
  [/^'[^\s(),'"#:^@!]+/u, 'block'],
  [/^@[^\s(),'"#:^]+/u, 'site'],
  [/^![^\s(),'"#:^]+/u, 'bone'],
  [/^\^[^\s(),'"#:]+/u, 'constant'],
  [/^[-+]?(?:\d+\.?\d*|\.\d+)/, 'number'],
  [/^[\p{L}][^\s(),'"#:^@!]*/u, 'operator'],
];

export const azee = StreamLanguage.define({
  name: 'azee',
  token(stream) {
    if (stream.eatSpace()) return null;
    for (const [pattern, kind] of WORDS) if (stream.match(pattern)) return kind;
    stream.next();
    return null;
  },
  languageData: { commentTokens: { line: '#' } },
  tokenTable: {
    rule, block, site, bone, comment: tags.lineComment, string: tags.string,
    constant: tags.constant(tags.name), number: tags.number, operator: tags.keyword,
  },
});

export const colours = syntaxHighlighting(HighlightStyle.define([
  { tag: tags.lineComment, color: '#5f6672', fontStyle: 'italic' },
  { tag: tags.string, color: '#7a4b00' },
  { tag: tags.number, color: '#7a4b00' },
  { tag: tags.keyword, color: '#4b3a8c', fontWeight: '600' },
  { tag: tags.constant(tags.name), color: '#8a2c5c' },
  { tag: rule, color: '#0a5f63', fontWeight: '600' },
  { tag: block, color: '#56410f' },
  { tag: site, color: '#1d5d9b' },
  { tag: bone, color: '#1d5d9b' },
]));
