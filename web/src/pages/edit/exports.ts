/** What can be taken away from the editor: the model, its curves as numbers, the view as a picture. */

import { csv, download, type Plot } from "../../draw";
import { force_cN, places_mm } from "../../math";
import type { FDVVModel } from "../../model";
import { tell } from "../../ui";
import type { Action } from "../../ui/menu";
import type { EditorController } from "./editor_controller";

/** What the menu offers. */
export function exportsOf({ model }: EditorController, plot: Plot): Action[] {
  const save = (end: string, data: string | Blob, type?: string) =>
    download(`${model.peek().name}.${end}`, data, type);
  return [
    ["Model file", () => save("fdvv.json", modelText(model.peek()), "application/json")],
    ["Curves, CSV", () => save("csv", curvesCsv(model.peek()), "text/csv")],
    ["View, PNG", () => void plot.toPng().then((blob) => save("png", blob), tell)],
    ["View, SVG", () => save("svg", plot.toSvg(), "image/svg+xml")],
  ];
}

/** A model as the text of its file. */
function modelText(model: FDVVModel): string {
  return `${JSON.stringify(model, null, 2)}\n`;
}

/** Every curve every 0.01 mm, two columns each. */
function curvesCsv(model: FDVVModel): string {
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
