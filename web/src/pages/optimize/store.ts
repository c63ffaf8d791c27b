/** One run as the server knows it, and followed while the page is open. */

import { workOn } from "../../app/current";
import { Followed } from "../../app/followed";
import { nameOf } from "../../app/names";
import { call, live } from "../../net";
import type { OptimizeCurve, OptimizeDetail, OptimizeScore, OptimizeTrial } from "../../net/messages";
import { Busy, onCleanup, type Signal, signal, toast, unitText } from "../../ui";

export type Design = Readonly<Record<string, number>>;

export class RunStore extends Followed<OptimizeDetail> {
  /** Id of the button that the best design was saved as; empty before. */
  readonly saved: Signal<string> = signal("");
  readonly saving = new Busy();
  /** Number of the trial that is looked at; null: the newest. */
  readonly chosen: Signal<number | null> = signal<number | null>(null);

  constructor(readonly run: number) {
    super(() => call("optimize.detail", { run }));
    const channel = live().channel("optimize", {
      opened: (channel) => void channel.send({ type: "watch" }),
      onMessage: (news) => {
        if (news.type === "watching" || news.run === run) void this.refresh();
      },
    });
    onCleanup(() => channel.close());
    void this.refresh();
  }

  /** Return the trial that is looked at. */
  trial(): OptimizeTrial | null {
    const trials = this.detail()?.trials ?? [];
    return trials[this.chosen() ?? trials.length - 1] ?? trials.at(-1) ?? null;
  }

  /** Return the trial that waits or is under way. */
  open(): OptimizeTrial | null {
    return (
      this.detail()?.trials.find((trial) => trial.state === "suggested" || trial.state === "shown") ?? null
    );
  }

  /** Number of the trial that waits or is under way, of the search or the retest. */
  openNumber(): number | null {
    return this.open()?.number ?? this.detail()?.retest.open ?? null;
  }

  /** Number of the trial whose presses are all kept and whose questions are not answered. */
  waiting(): number | null {
    return this.detail()?.questions?.trial ?? null;
  }

  /** Whether another compromise may be taken: between the search and its retest. */
  choosing(): boolean {
    const detail = this.detail();
    return !!detail && detail.compromise !== null && detail.retest.done === 0 && detail.retest.open === null;
  }

  /** Whether the best design and the start are played again now, blind. */
  retesting(): boolean {
    const detail = this.detail();
    return !!detail?.searched && detail.retest.done < detail.retest.total;
  }

  /** Whether the budget is used up. */
  full(): boolean {
    const row = this.detail()?.row;
    return !!row && row.spent >= row.budget;
  }

  /** Save a design, null : the recommended one, as a button of one's own, which is worked on from then on. */
  save(chosen: Design | null, name: string): Promise<void> {
    return this.saving.run(async () => {
      const design = chosen ?? (await call("optimize.best", { run: this.run })).design ?? {};
      const button = await saveDesign(this.run, design, name);
      this.saved.set(button);
      toast(`Saved as ${nameOf(button)}.`, "done");
    });
  }

  /** Name of the first objective. */
  objective(): string {
    return this.detail()?.objectives[0]?.name ?? "asynchrony_ms";
  }

  /** How many trials are done, or comparisons and lines answered. */
  count(): number {
    const { pairs = [], lines = [] } = this.detail() ?? {};
    const answered = [...pairs.map(({ answer }) => answer), ...lines.map(({ best }) => best)];
    return this.done().length + answered.filter((answer) => answer !== null).length;
  }

  done(): readonly OptimizeTrial[] {
    return (this.detail()?.trials ?? []).filter((trial) => trial.state === "done");
  }
}

/** Save a design of a run's space as a button, which is worked on from then on; return its id. */
export async function saveDesign(run: number, design: Design, name: string): Promise<string> {
  const { model } = await call("optimize.model", { run, design, name });
  const { button } = await call("document.create", { name: name || null, template: null, model });
  workOn(button);
  return button;
}

/** Propose a name for the best design of a run. */
export function foundName({ start_name, row }: OptimizeDetail): string {
  return `${start_name.replace(/^.* nearest to |^the first design$/, "") || "Run"} found ${row.run}`;
}

const UNITS: Readonly<Record<string, string>> = {
  mm: "mm",
  cN: "cN",
  cN_mm: "cN/mm",
  ms: "ms",
  ratio: "",
  Hz: "Hz",
  N_s: "N s",
  mm_s: "mm/s",
};

/** Write a name with its unit for people: "asynchrony_ms" is "asynchrony" in "ms". */
export function named(name: string): { readonly label: string; readonly unit: string } {
  const suffix = Object.keys(UNITS)
    .filter((one) => name.endsWith(`_${one}`))
    .sort((a, b) => b.length - a.length)[0];
  if (suffix === undefined) return { label: name.replaceAll("_", " "), unit: "" };
  return { label: name.slice(0, -suffix.length - 1).replaceAll("_", " "), unit: UNITS[suffix] as string };
}

/** Write a name with its unit for the head of a column or row. */
export function headed(name: string): string {
  const { label, unit } = named(name);
  return unit ? `${label}, ${unitText(unit)}` : label;
}

export function scoreText(score: OptimizeScore | undefined, unit: string): string {
  if (!score) return "–";
  const error = score.error === null ? "" : ` ± ${round(score.error)}`;
  return `${round(score.value)}${error}${unit ? ` ${unit}` : ""}`;
}

function round(value: number): string {
  return value.toFixed(Math.abs(value) < 10 ? 2 : 1).replace("-", "−");
}

/** Return positions and forces of a small picture's curve. */
export function curveLine(curve: OptimizeCurve): {
  readonly x_mm: number[];
  readonly y_cN: readonly number[];
} {
  return { x_mm: curve.force_cN.map((_, i) => i * curve.step_mm), y_cN: curve.force_cN };
}
