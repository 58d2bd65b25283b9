// The text: CodeMirror with the language server, and marks for what is signed now.
import { autocompletion, closeBrackets, closeBracketsKeymap, completionKeymap } from '@codemirror/autocomplete';
import {
  defaultKeymap, history, historyKeymap, indentWithTab, isolateHistory,
} from '@codemirror/commands';
import { bracketMatching, indentOnInput, indentService, indentUnit } from '@codemirror/language';
import { lintKeymap } from '@codemirror/lint';
import {
  findReferencesKeymap, formatKeymap, hoverTooltips, jumpToDefinitionKeymap, LSPClient,
  renameKeymap, serverCompletion, serverDiagnostics, signatureHelp, type Transport,
} from '@codemirror/lsp-client';
import { highlightSelectionMatches, searchKeymap } from '@codemirror/search';
import { Annotation, Compartment, EditorState, StateEffect, StateField, Transaction } from '@codemirror/state';
import {
  Decoration, type DecorationSet, EditorView, highlightActiveLine, highlightSpecialChars, keymap,
  lineNumbers,
} from '@codemirror/view';
import { azee, colours } from './azee-language';
import { sanitized } from './sanitized';

const LONGEST_ANSWER_MS = 30_000;

/** Marks a change that the page made itself, so that it is not taken for typing. */
const loaded = Annotation.define<boolean>();

const setMarks = StateEffect.define<readonly { from: number; kind: 'now' | 'chosen' }[]>();

const marks = StateField.define<DecorationSet>({
  create: () => Decoration.none,
  update(value, transaction) {
    let now = value.map(transaction.changes);
    for (const effect of transaction.effects)
      if (effect.is(setMarks)) now = lines(transaction.state, effect.value);
    return now;
  },
  provide: field => EditorView.decorations.from(field),
});

function lines(
  state: EditorState, wanted: readonly { from: number; kind: 'now' | 'chosen' }[],
): DecorationSet {
  const found = new Map<number, Set<string>>();
  for (const { from, kind } of wanted) {
    const start = state.doc.lineAt(Math.min(from, state.doc.length)).from;
    found.set(start, (found.get(start) ?? new Set()).add(`line-${kind}`));
  }
  return Decoration.set([...found].sort(([a], [b]) => a - b)
    .map(([at, kinds]) => Decoration.line({ class: [...kinds].join(' ') }).range(at)));
}

/** A new line is as deep as the one before. */
const asDeep = indentService.of((context, at) => {
  const line = context.lineAt(at, -1);
  const before = context.state.doc.lineAt(Math.max(0, line.from - 1));
  return /^\s*/.exec(line.text.trim() ? line.text : before.text)![0].length;
});

export class Editor {
  readonly view: EditorView;
  private readonly language = new Compartment();
  private readonly label = new Compartment();
  private client: LSPClient | null = null;

  constructor(
    parent: HTMLElement, label: string,
    private readonly typed: (text: string) => void, private readonly moved: (offset: number) => void,
    private readonly keys: Record<string, () => void>,
  ) {
    this.view = new EditorView({ parent, state: this.fresh('', label) });
  }

  private fresh(text: string, label: string): EditorState {
    const own = Object.entries(this.keys).map(([key, run]) => ({
      key, preventDefault: true, run: () => { run(); return true; },
    }));
    return EditorState.create({
      doc: text,
      extensions: [
        lineNumbers(), highlightSpecialChars(), history(), indentUnit.of('    '), asDeep,
        indentOnInput(), bracketMatching(), closeBrackets(), highlightActiveLine(),
        highlightSelectionMatches(), autocompletion({ selectOnOpen: false }), azee, colours, marks, EditorView.lineWrapping,
        this.language.of([]),
        this.label.of(EditorView.contentAttributes.of({ 'aria-label': label })),
        keymap.of([
          ...own, ...closeBracketsKeymap, ...defaultKeymap, ...searchKeymap, ...historyKeymap,
          ...completionKeymap, ...lintKeymap, ...formatKeymap, ...renameKeymap,
          ...jumpToDefinitionKeymap, ...findReferencesKeymap, indentWithTab,
        ]),
        EditorView.updateListener.of(update => {
          if (update.docChanged && !update.transactions.some(t => t.annotation(loaded)))
            this.typed(this.text);
          else if (update.selectionSet) this.moved(update.state.selection.main.head);
        }),
      ],
    });
  }

  get text(): string {
    return this.view.state.doc.toString();
  }

  /** Shows another text, with an undo history of its own. */
  open(text: string, label: string): void {
    this.view.setState(this.fresh(text, label));
  }

  rename(label: string): void {
    const named = EditorView.contentAttributes.of({ 'aria-label': label });
    this.view.dispatch({ effects: this.label.reconfigure(named) });
  }

  /** Replaces the text in one step that can be undone. `quiet`: it is not taken for typing. */
  replace(text: string, quiet = false): void {
    const old = this.text;
    let start = 0, end = 0;
    while (start < Math.min(old.length, text.length) && old[start] === text[start]) start++;
    while (end < Math.min(old.length, text.length) - start
      && old[old.length - 1 - end] === text[text.length - 1 - end]) end++;
    if (old === text) return;
    this.view.dispatch({
      changes: { from: start, to: old.length - end, insert: text.slice(start, text.length - end) },
      annotations: [isolateHistory.of('full'), ...(quiet ? [loaded.of(true)] : [])],
    });
  }

  /** Makes a change that can be undone by itself. */
  change(from: number, to: number, insert: string): void {
    this.view.dispatch({ changes: { from, to, insert }, annotations: isolateHistory.of('full') });
  }

  /** Inserts at the cursor, or over the selection. `select`: offsets in what is inserted. */
  insert(text: string, select: readonly [number, number]): void {
    const { from, to } = this.view.state.selection.main;
    this.view.dispatch({
      changes: { from, to, insert: text },
      selection: { anchor: from + select[0], head: from + select[1] },
      annotations: [isolateHistory.of('full'), Transaction.userEvent.of('input.palette')],
      scrollIntoView: true,
    });
    this.view.focus();
  }

  /** Returns the offset of a line and column, from 1, columns in code points. */
  offset(line: number, column: number): number {
    const found = this.view.state.doc.line(Math.min(Math.max(1, line), this.view.state.doc.lines));
    const before = [...found.text].slice(0, column - 1).join('');
    return found.from + before.length;
  }

  /** Returns line and column, from 1, of an offset. */
  place(offset: number): [number, number] {
    const line = this.view.state.doc.lineAt(offset);
    return [line.number, [...line.text.slice(0, offset - line.from)].length + 1];
  }

  goTo(line: number, column: number): void {
    const at = this.offset(line, column);
    this.view.dispatch({ selection: { anchor: at }, scrollIntoView: true });
    this.view.focus();
  }

  mark(now: readonly [number, number][], chosen: readonly [number, number] | null): void {
    const wanted: { from: number; kind: 'now' | 'chosen' }[] = now.map(([line, column]) =>
      ({ from: this.offset(line, column), kind: 'now' }));
    if (chosen) wanted.push({ from: this.offset(...chosen), kind: 'chosen' });
    this.view.dispatch({ effects: setMarks.of(wanted) });
  }

  /** Connects the text with a language server; again, after the connection came back. */
  connect(transport: Transport, root: string, uri: string): void {
    this.client?.disconnect();
    this.client = new LSPClient({
      rootUri: root,
      timeout: LONGEST_ANSWER_MS,
      sanitizeHTML: sanitized,
      extensions: [serverCompletion(), serverDiagnostics(), hoverTooltips(), signatureHelp()],
    });
    this.client.connect(transport);
    this.client.initializing.catch(() => undefined); // the connection went; it is made again
    this.view.dispatch({ effects: this.language.reconfigure(this.client.plugin(uri, 'azee')) });
  }
}
