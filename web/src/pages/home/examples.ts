/** Comparisons to begin with, each a small picture of its press curves. */

import { series } from "../../draw";
import { call } from "../../net";
import type { LibraryButton } from "../../net/messages";
import { strokeAt } from "../library/curves";

export interface Example {
  readonly title: string;
  readonly about: string;
  readonly ids: readonly string[];
}

export const EXAMPLES: readonly Example[] = [
  {
    title: "Linear, tactile, clicky",
    about: "Three families of switches",
    ids: ["builtin:mx-red", "builtin:mx-brown", "builtin:mx-blue"],
  },
  {
    title: "A light and a strong bump",
    about: "Two tactile switches",
    ids: ["builtin:mx-brown", "builtin:mx-clear"],
  },
  {
    title: "A switch and a dome",
    about: "Metal contact, rubber dome",
    ids: ["builtin:mx-clear", "builtin:rubber-dome"],
  },
];

/** The axes of all pictures, so that they compare too. */
export const VIEW = { width: 200, height: 96, travel_mm: 4.2, force_cN: 96 } as const;

/** Return the buttons of all examples by their ids. */
export async function exampleButtons(): Promise<ReadonlyMap<string, LibraryButton>> {
  const ids = [...new Set(EXAMPLES.flatMap((one) => one.ids))];
  const { buttons } = await call("library.curves", { ids });
  return new Map(buttons.map((button) => [button.id, button]));
}

export interface Drawn {
  readonly name: string;
  readonly colour: string;
  /** Points of a polyline. */
  readonly press: string;
}

/** Return the curves of an example, in the colours of the comparison that it opens. */
export function drawnOf(example: Example, buttons: ReadonlyMap<string, LibraryButton>): Drawn[] {
  return example.ids.flatMap((id, n) => {
    const button = buttons.get(id);
    const stroke = button && strokeAt(button, "press", null);
    return stroke ? [{ name: button.name, colour: series(n).colour, press: points(stroke) }] : [];
  });
}

function points(stroke: { start_mm: number; step_mm: number; force_cN: readonly number[] }): string {
  const every = Math.max(1, Math.floor(stroke.force_cN.length / VIEW.width));
  return stroke.force_cN
    .map((force, i) => [stroke.start_mm + i * stroke.step_mm, force] as const)
    .filter(([, force], i) => i % every === 0 && Number.isFinite(force))
    .map(([x, force]) => {
      const left = (VIEW.width * x) / VIEW.travel_mm;
      return `${left.toFixed(1)},${(VIEW.height * (1 - force / VIEW.force_cN)).toFixed(1)}`;
    })
    .join(" ");
}
