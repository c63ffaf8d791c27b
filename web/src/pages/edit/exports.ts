/** What can be taken away from the editor: the model, its curves as numbers, the view as a picture. */

import { csv, download, type Plot } from "../../draw";
import { force_cN, places_mm } from "../../math";
import type { FDVVModel } from "../../model";
import { button, tell } from "../../ui";
import type { EditorController } from "./editor_controller";
import { dropDown } from "./menu";

/** A menu that opens under its name. */
export function exportMenu(editor: EditorController, plot: Plot): HTMLElement {
  const name = () => editor.model.peek().name;
  const picture = () => plot.toPng().then((blob) => download(`${name()}.png`, blob), tell);
  const items = [
    button({
      label: "Model file",
      kind: "quiet",
      act: () => download(`${name()}.fdvv.json`, modelText(editor.model.peek()), "application/json"),
    }),
    button({
      label: "Curves, CSV",
      kind: "quiet",
      act: () => download(`${name()}.csv`, curvesCsv(editor.model.peek()), "text/csv"),
    }),
    button({ label: "View, PNG", kind: "quiet", act: () => void picture() }),
    button({
      label: "View, SVG",
      kind: "quiet",
      act: () => download(`${name()}.svg`, plot.toSvg(), "image/svg+xml"),
    }),
  ];
  return dropDown("Export", items);
}

/** A model as the text of its file. */
export function modelText(model: FDVVModel): string {
  return `${JSON.stringify(model, null, 2)}\n`;
}

/** Every curve every 0.01 mm, two columns each. */
export function curvesCsv(model: FDVVModel): string {
  const columns = model.curves.flatMap((curve) => {
    const what = `${curve.stroke}_${curve.velocity_mm_s ?? "unknown"}_mm_s`;
    const x_mm = places_mm(curve, 0.01);
    return [
      [`${what}_displacement_mm`, Array.from(x_mm, (x) => Number(x.toFixed(6)))],
      [`${what}_force_cN`, Array.from(force_cN(curve, x_mm), (f) => Number(f.toFixed(6)))],
    ] as const;
  });
  return csv(columns);
}
