/** What a person drops or chooses: the files, those in folders too, in parts that one question can carry. */

/** A file and its name with the folders above it. */
export interface Picked {
  readonly name: string;
  readonly file: File;
}

const MOST_FILES = 64;
/** Of the files of a question: the server takes 8 MB, and a third goes for writing bytes as text. */
export const MOST_bytes = 5_900_000;
/** More than this is a drive, not a collection of buttons. */
export const MOST_PICKED = 2000;
const STROKE = /[._](downstroke|upstroke|press|release)(?=\.[^.]*$)/i;

/** Id of the page's input for files. */
export const PICKER = "files-to-open";

/** Let the person choose files; to be called while a click or a key lasts. */
export function choose(): void {
  document.getElementById(PICKER)?.click();
}

/** Whether a drag carries files. */
export function carriesFiles(data: DataTransfer | null): data is DataTransfer {
  return data?.types.includes("Files") ?? false;
}

/** Return what was dropped; folders are walked. Must be called while the event lasts. */
export async function dropped(data: DataTransfer): Promise<Picked[]> {
  const found: Picked[] = [];
  const items = [...data.items].filter((item) => item.kind === "file");
  // both must be asked for now: the items are gone when the event is over
  const entries = items.map((item) => [item.webkitGetAsEntry(), item.getAsFile()] as const);
  for (const [entry, file] of entries) {
    if (entry?.isDirectory) await walk(entry, found);
    else if (file) found.push({ name: file.name, file });
  }
  return sorted(found);
}

/** Return what was chosen in a dialog of the browser. */
export function chosen(files: Iterable<File>): Picked[] {
  return sorted([...files].map((file) => ({ name: file.webkitRelativePath || file.name, file })));
}

async function walk(entry: FileSystemEntry, found: Picked[]): Promise<void> {
  if (entry.name.startsWith(".") || found.length >= MOST_PICKED) return;
  if (entry.isDirectory) {
    const reader = (entry as FileSystemDirectoryEntry).createReader();
    const next = () => new Promise<FileSystemEntry[]>((resolve, no) => reader.readEntries(resolve, no));
    // a folder is handed out a hundred entries at a time
    for (let some = await next(); some.length; some = await next())
      for (const one of some) await walk(one, found);
  } else {
    const file = await new Promise<File>((resolve, no) => (entry as FileSystemFileEntry).file(resolve, no));
    found.push({ name: entry.fullPath.replace(/^\//, ""), file });
  }
}

function sorted(files: Picked[]): Picked[] {
  return files.sort((a, b) => a.name.localeCompare(b.name, undefined, { numeric: true }));
}

/** Return the name that the two files of a press and its release share. */
export function pairOf({ name }: Picked): string {
  return name.replace(STROKE, "");
}

/** Split files into questions; the two files of a pair stay together. */
export function questions(files: readonly Picked[]): Picked[][] {
  const pairs = new Map<string, Picked[]>();
  for (const one of files) pairs.set(pairOf(one), [...(pairs.get(pairOf(one)) ?? []), one]);
  const size = (some: readonly Picked[]) => some.reduce((sum, { file }) => sum + file.size, 0);
  const made: Picked[][] = [];
  for (const pair of pairs.values()) {
    const last = made.at(-1);
    const fits = last && last.length + pair.length <= MOST_FILES && size(last) + size(pair) <= MOST_bytes;
    if (fits) last.push(...pair);
    else made.push(pair);
  }
  return made;
}
