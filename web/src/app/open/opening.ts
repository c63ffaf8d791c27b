/** Files that are being opened: the server reads them in parts, a person looks, and keeps what is wanted. */

import { lineOf } from "../../math/words";
import { call } from "../../net";
import type { DroppedFile, FileButton } from "../../net/messages";
import { type Signal, signal } from "../../ui/signal.svelte";
import { MOST_bytes, MOST_PICKED, type Picked, pairOf, questions } from "./collect";
import { asWav, isSound } from "./sound";

/** A button of a file, with nothing left out. */
export type Held = Required<FileButton>;

/** What a file turned out to hold. */
export interface Found {
  readonly key: number;
  /** The file, and the one of the other stroke. */
  readonly sources: readonly Picked[];
  readonly kind: "button" | "sound" | "program";
  readonly button: Held;
  /** To keep it under: the server's proposal, until the person writes another one. */
  readonly name: string;
  /** Id under which it was kept; empty before. */
  readonly kept: string;
}

interface Choices {
  readonly accept_implausible?: boolean;
  readonly full_scale_m_s2?: number;
}

export class Opening {
  readonly found: Signal<readonly Found[]> = signal<readonly Found[]>([]);
  /** Files that are read, of how many; null when all are. */
  readonly progress: Signal<readonly [number, number] | null> = signal<readonly [number, number] | null>(
    null,
  );
  private made = 0;
  private readonly stopped = new AbortController();

  /** into: id of the button that the page shows, which a vibration is given to; null if there is none. */
  constructor(readonly into: string | null) {}

  /** Read more files; what is wrong with one is said beside it. */
  async read(files: readonly Picked[]): Promise<void> {
    let done = 0;
    const some = files.slice(0, MOST_PICKED);
    this.progress.set([0, some.length]);
    for (const part of parts(some)) {
      const found = await this.readPart(part).catch((error: unknown) => this.refused(part, error));
      if (this.stopped.signal.aborted) return;
      done += part.length;
      for (const one of found) this.found.update((all) => [...all, renamed(one, all)]);
      this.progress.set([done, some.length]);
    }
    this.progress.set(null);
  }

  /** Read one again: a doubted file that is accepted, a sound whose full scale is known now. */
  async again(one: Found, choices: Choices): Promise<void> {
    const next = await this.ask(one.sources, choices).catch((error: unknown) =>
      this.refused(one.sources, error),
    );
    const button = next[0]?.button ?? one.button;
    const kind = button.reason && one.kind === "sound" ? "sound" : "button";
    const others = this.found.peek().filter(({ key }) => key !== one.key);
    this.replace(renamed({ ...one, kind, button, name: button.name }, others));
  }

  rename(one: Found, name: string): void {
    this.replace({ ...one, name });
  }

  /** Keep one under its name; return its id. Throws one line. */
  async keep(one: Found): Promise<string> {
    const kept =
      one.kind === "program"
        ? (await call("program.keep", { text: await one.sources[0]!.file.text() })).program
        : (await call("document.create", { name: one.name.trim(), template: null, model: one.button.model }))
            .button;
    this.replace({ ...one, kept });
    return kept;
  }

  stop(): void {
    this.stopped.abort();
  }

  private replace(next: Found): void {
    this.found.update((all) => all.map((one) => (one.key === next.key ? next : one)));
  }

  private async readPart(part: readonly Picked[]): Promise<Found[]> {
    const [one] = part as [Picked];
    if (one.file.size > MOST_bytes)
      throw new Error(
        `${one.name}: larger than ${MOST_bytes / 1e6} MB; fdvv fit reads it on the command line`,
      );
    if (isProgram(one)) return [this.local(one, "program", "")];
    if (!isSound(one)) return this.ask(part, {});
    const alone = `${one.name}: a sound; open the button that it belongs to in Edit, and drop it there`;
    return [this.local(one, "sound", this.into ? "" : alone)];
  }

  private async ask(sources: readonly Picked[], choices: Choices): Promise<Found[]> {
    const readable = await Promise.all(sources.map((one) => (isSound(one) ? asWav(one) : one)));
    const files = await Promise.all(readable.map(written));
    const { buttons } = await call(
      "file.read",
      { files, into: this.into, full_scale_m_s2: null, accept_implausible: false, ...choices },
      this.stopped.signal,
    );
    let at = 0;
    return buttons.map((button) => {
      // buttons come in the order of the files
      const place = sources.findIndex((one, i) => i >= at && baseName(one) === button.file);
      at = Math.max(at, place + 1);
      const pair = place < 0 ? sources : sources.filter((one) => pairOf(one) === pairOf(sources[place]!));
      return this.madeOf(pair, "button", { ...NOTHING, ...button });
    });
  }

  private refused(part: readonly Picked[], error: unknown): Found[] {
    return part.map((one) => this.local(one, "button", lineOf(error)));
  }

  private local(one: Picked, kind: Found["kind"], reason: string): Found {
    return this.madeOf([one], kind, { ...NOTHING, file: baseName(one), reason });
  }

  private madeOf(sources: readonly Picked[], kind: Found["kind"], button: Held): Found {
    return { key: this.made++, sources, kind, button, name: button.name, kept: "" };
  }
}

/** The server proposes names that are free there; two files of a name need two here. */
function renamed(one: Found, others: readonly Found[]): Found {
  const taken = new Set(others.map(({ name }) => name.toLowerCase()));
  let name = one.name;
  for (let n = 2; name && taken.has(name.toLowerCase()); n++) name = `${one.name.replace(/ \d+$/, "")} ${n}`;
  return { ...one, name };
}

const NOTHING: Omit<Held, "file" | "reason"> = {
  name: "",
  doubted: false,
  sentence: "",
  notes: [],
  model: null,
  strokes: [],
  samples: [],
  fits: [],
};

/** Files that stand for themselves are parts of their own: sounds, programs, and what is too large. */
function parts(files: readonly Picked[]): Picked[][] {
  const single = (one: Picked) => isSound(one) || isProgram(one) || one.file.size > MOST_bytes;
  return [...questions(files.filter((one) => !single(one))), ...files.filter(single).map((one) => [one])];
}

function isProgram({ name }: Picked): boolean {
  return /\.fdvv-program\.json$/i.test(name);
}

function baseName({ name }: Picked): string {
  return name.slice(name.lastIndexOf("/") + 1);
}

/** A file as a question carries it: its bytes in base64. */
async function written({ name, file }: Picked): Promise<DroppedFile> {
  const bytes = new Uint8Array(await file.arrayBuffer());
  let text = "";
  for (let i = 0; i < bytes.length; i += 0x8000)
    text += String.fromCharCode(...bytes.subarray(i, i + 0x8000));
  return { name, content: btoa(text) };
}
