/** Edits of the selected control points that keys, buttons and tables share. */

import { controlPoints_mm } from "../../math";
import { addPoint, removePoint, together } from "../../model";
import { type EditorController, refOf } from "./editor_controller";

/** Remove the selected control points as one step; the shape changes as little as it can. */
export function removeSelected(editor: EditorController): void {
  const rows = [...editor.selection.peek()].sort((a, b) => b - a);
  if (!rows.length) return;
  const at = refOf(editor.curve());
  const what = rows.length === 1 ? "remove a point" : `remove ${rows.length} points`;
  if (
    editor.apply(
      together(
        what,
        rows.map((row) => removePoint(at, row)),
      ),
    )
  )
    editor.selection.set([]);
}

/** Add a control point to the active curve and select it; the shape stays. */
export function addAt(editor: EditorController, x_mm: number): void {
  if (!editor.apply(addPoint(refOf(editor.curve()), x_mm))) return;
  const positions = controlPoints_mm(editor.curve());
  let nearest = 0;
  positions.forEach((at, i) => {
    if (Math.abs(at - x_mm) < Math.abs(positions[nearest]! - x_mm)) nearest = i;
  });
  editor.selection.set([nearest]);
}

/** Add a point half-way behind the last selected one. */
export function addBehind(editor: EditorController): void {
  const positions = controlPoints_mm(editor.curve());
  const row = Math.min(
    positions.length - 2,
    editor.selection.peek().at(-1) ?? Math.floor(positions.length / 2),
  );
  const x_mm = 0.5 * (positions[row]! + positions[row + 1]!);
  if (editor.apply(addPoint(refOf(editor.curve()), Number(x_mm.toFixed(4))))) editor.selection.set([row + 1]);
}
