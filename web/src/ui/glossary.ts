/** What terms mean, by the document that explains them. */

import text from "../../../docs/reference/glossary.md?raw";

const ENTRY = /^- \*\*(.+?)\*\*: ((?:.|\n {2})+)/gm;

/** Read the entries of a glossary: `- **term**: what it means`. */
export function entriesOf(markdown: string): ReadonlyMap<string, string> {
  const plain = (meaning: string) => meaning.replace(/\n {2}/g, " ").replace(/\*(\w+)\*/g, "$1");
  return new Map([...markdown.matchAll(ENTRY)].map(([, term, meaning]) => [term!, plain(meaning!)]));
}

/** Every term and what it means. */
export const GLOSSARY: ReadonlyMap<string, string> = entriesOf(text);
