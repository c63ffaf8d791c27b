/** One key of the person's keyboard, read live or from a recording: the same readings either way. */

import { type Signal, signal } from "../ui/signal.svelte";
import { Depths, type Sample } from "./depths";
import { type OpenKeyboard, openKeyboard } from "./hid";
import { keyCode, keyName } from "./key_names";
import { play } from "./player";
import { LONGEST_ms, type Recording } from "./recording";
import type { ReportFormat } from "./reports";

/** none: nothing is read. choosing: a keyboard is open, no key chosen yet. */
export type KeyStatus = "none" | "choosing" | "live" | "playing";

const FULL_SCALE = "fdvv-key-travel";
/** What keyboards of this kind mostly have. */
const FULL_mm = 4;
/** A key that is so deep has been chosen. */
const CHOSEN_ratio = 0.3;

interface Chosen {
  readonly format: ReportFormat;
  readonly code: number;
}

export class AnalogKey {
  readonly status: Signal<KeyStatus> = signal<KeyStatus>("none");
  /** Of the keyboard, or of the recording that is played. */
  readonly device: Signal<string> = signal("");
  readonly key: Signal<string> = signal("");
  /** How what is played was made, if not by a key. */
  readonly simulated: Signal<string> = signal("");
  /** One line about what could not be read. */
  readonly problem: Signal<string> = signal("");
  /** What the person says of the key's travel. */
  readonly full_scale_mm: Signal<number> = signal(Number(localStorage.getItem(FULL_SCALE)) || FULL_mm);
  readonly repeat: Signal<boolean> = signal(false);
  readonly recording: Signal<boolean> = signal(false);
  readonly depths = new Depths();
  private keyboard: OpenKeyboard | null = null;
  private chosen: Chosen | null = null;
  /** The browser's name of the key; empty while it is not known. */
  private code = "";
  private kept: { readonly t_ms: number[]; readonly depth_mm: number[] } | null = null;
  private stop: (() => void) | null = null;
  private readonly listeners = new Set<(sample: Sample) => void>();

  /** Hear every reading; its own events of the keyboard do nothing meanwhile. The function returned ends it. */
  follow(listener: (sample: Sample) => void): () => void {
    if (!this.listeners.size)
      for (const kind of ["keydown", "keyup"] as const) addEventListener(kind, this.swallow, true);
    this.listeners.add(listener);
    return () => {
      this.listeners.delete(listener);
      if (this.listeners.size) return;
      for (const kind of ["keydown", "keyup"] as const) removeEventListener(kind, this.swallow, true);
    };
  }

  /** Open a keyboard; then the person chooses a key by pressing it. Throws an Error of one line. */
  async connect(another = false): Promise<void> {
    this.problem.set("");
    if (another) this.disconnect();
    this.keyboard ??= await openKeyboard(
      {
        keys: (format, keys, at_ms) => this.take(format, keys, at_ms),
        problem: (line) => this.problem.peek() !== line && this.problem.set(line),
        lost: () => this.lost(),
      },
      another,
    );
    if (this.keyboard) this.choose();
  }

  choose(): void {
    this.halt();
    this.chosen = null;
    this.code = "";
    this.depths.clear();
    this.begin("choosing", this.keyboard?.name ?? "", "", "");
  }

  disconnect(): void {
    this.halt();
    this.keyboard?.close();
    this.keyboard = null;
    this.chosen = null;
    this.begin("none", "", "", "");
  }

  setFullScale(mm: number): void {
    this.full_scale_mm.set(mm);
    localStorage.setItem(FULL_SCALE, String(mm));
  }

  /** Play a recording in place of the keyboard. */
  play(recording: Recording): void {
    this.halt();
    this.problem.set("");
    this.depths.clear();
    this.begin("playing", recording.device, recording.key, recording.simulated);
    const read = (at_ms: number, depth_mm: number) => this.read(at_ms, depth_mm);
    this.stop = play(
      recording,
      read,
      () => this.repeat.peek(),
      () => this.halt(),
    );
  }

  /** Stop what is played; the keyboard goes on, if there is one. */
  halt(): void {
    if (!this.stop) return;
    this.stop();
    this.stop = null;
    if (this.depths.last_mm() > 0) this.read(performance.now(), 0);
    const live = this.keyboard && this.chosen;
    this.begin(live ? "live" : this.keyboard ? "choosing" : "none", this.keyboard?.name ?? "", "", "");
    if (live) this.key.set(keyName(this.code, live.code));
  }

  record(): void {
    this.kept = { t_ms: [], depth_mm: [] };
    this.recording.set(true);
  }

  /** End recording; null if nothing was read meanwhile. */
  recorded(): Recording | null {
    const { t_ms, depth_mm } = this.kept ?? { t_ms: [], depth_mm: [] };
    this.kept = null;
    this.recording.set(false);
    const [start_ms, end_ms] = [t_ms[0] ?? 0, t_ms.at(-1) ?? 0];
    if (!(end_ms > start_ms)) return null;
    return {
      device: this.device.peek(),
      key: this.key.peek(),
      rate_Hz: ((t_ms.length - 1) / (end_ms - start_ms)) * 1000,
      full_scale_mm: this.full_scale_mm.peek(),
      simulated: this.simulated.peek(),
      t_ms: t_ms.map((t) => t - start_ms),
      depth_mm,
    };
  }

  private begin(status: KeyStatus, device: string, key: string, simulated: string): void {
    this.device.set(device);
    this.key.set(key);
    this.simulated.set(simulated);
    this.status.set(status);
  }

  private take(format: ReportFormat, keys: ReadonlyMap<number, number>, at_ms: number): void {
    const status = this.status.peek();
    if (status === "choosing") this.choosing(format, keys);
    else if (status === "live" && this.chosen?.format === format)
      this.read(at_ms, (keys.get(this.chosen.code) ?? 0) * this.full_scale_mm.peek());
  }

  private choosing(format: ReportFormat, keys: ReadonlyMap<number, number>): void {
    const [deepest] = [...keys].sort((a, b) => b[1] - a[1]);
    if (!deepest || deepest[1] < CHOSEN_ratio) return;
    this.chosen = { format, code: deepest[0] };
    this.code = format.usages ? keyCode(deepest[0]) : "";
    this.begin("live", this.keyboard?.name ?? "", keyName(this.code, deepest[0]), "");
  }

  private read(at_ms: number, depth_mm: number): void {
    const sample = this.depths.add(at_ms, depth_mm);
    this.keep(at_ms, depth_mm);
    for (const listener of [...this.listeners]) listener(sample);
  }

  private keep(at_ms: number, depth_mm: number): void {
    if (!this.kept) return;
    if (at_ms - (this.kept.t_ms[0] ?? at_ms) <= LONGEST_ms) {
      this.kept.t_ms.push(at_ms);
      this.kept.depth_mm.push(depth_mm);
    } else if (!this.problem.peek()) this.problem.set("The recording is full: 120 s are kept.");
  }

  private lost(): void {
    this.keyboard = null;
    if (this.status.peek() === "playing") return;
    if (this.depths.last_mm() > 0) this.read(performance.now(), 0);
    this.disconnect();
    this.problem.set("The keyboard was unplugged.");
  }

  /** What the key would type must not press twice, nor work the page. */
  private readonly swallow = (event: KeyboardEvent): void => {
    const status = this.status.peek();
    const typing = event.target instanceof HTMLElement && event.target.matches("input[type=text], textarea");
    if (typing || (status !== "choosing" && status !== "live")) return;
    // of makers whose numbers say nothing of the key
    if (status === "live" && !this.code && !event.repeat && this.depths.last_mm() > 0) {
      this.code = event.code;
      this.key.set(keyName(this.code, 0));
    }
    if (status === "choosing" && event.code === "Escape") this.disconnect();
    const own = status === "choosing" ? !["Tab", "Escape"].includes(event.code) : event.code === this.code;
    if (!own) return;
    event.preventDefault();
    event.stopImmediatePropagation();
  };
}

/** The key of this page: once connected it stays so from page to page. */
export const analogKey = new AnalogKey();
