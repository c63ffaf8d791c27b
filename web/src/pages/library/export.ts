/** The view as a picture or as numbers. */

import { csv, download } from "../../draw";
import { call } from "../../net";
import { tell } from "../../ui";
import { speedText } from "./columns";
import { AXES, type Drawn, type Overlay } from "./overlay";
import type { Shown, ViewName } from "./state";

const NAME = "fdvv-buttons";

export function exportSvg(overlay: Overlay): void {
  download(
    `${NAME}.svg`,
    overlay.stamped(origin(), () => overlay.plot.toSvg()),
    "image/svg+xml",
  );
}

export function exportPng(overlay: Overlay): void {
  overlay
    .stamped(origin(), () => overlay.plot.toPng())
    .then((picture) => download(`${NAME}.png`, picture), tell);
}

export function exportCsv(overlay: Overlay, view: ViewName): void {
  download(`${NAME}.csv`, csv(columns(overlay.drawn(), view)), "text/csv");
}

/** Most that the server puts on a page. */
export const MOST_SHARED = 6;

/** Save a page of the compared buttons that needs nothing outside itself. */
export function share({ overlay, velocity_mm_s }: Shown): void {
  call("library.page", { ids: [...overlay], velocity_mm_s }).then(
    ({ name, html }) => download(name, html, "text/html"),
    tell,
  );
}

function origin(): string {
  return `fdvv studio, ${new Date().toISOString().slice(0, 10)}`;
}

/** Two columns for every curve: its displacement and its values; names say button, stroke and speed. */
export function columns(drawn: readonly Drawn[], view: ViewName): [string, ArrayLike<number>][] {
  const { label, unit } = AXES[view];
  return drawn.flatMap((one) => {
    const simulated = one.button.simulated ? ", simulated" : "";
    const who = `${one.button.name}${simulated}, ${one.stroke}, ${speedText(one.velocity_mm_s)}`;
    const round = (column: Float64Array) => Array.from(column, (value) => Number(value.toFixed(4)));
    return [
      [`${who}: displacement, mm`, round(one.line.x_mm)],
      [`${who}: ${label}, ${unit}`, round(one.line.y)],
    ] as [string, ArrayLike<number>][];
  });
}
