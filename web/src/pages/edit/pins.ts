/** States that are pinned to compare with. */

import type { EditorController } from "./editor_controller";

/** Keep the present state and compare with it. */
export function pin(editor: EditorController): void {
  const { store } = editor;
  store.pin(`pin ${store.pins.length + 1}: ${store.history.undoLabel ?? "as opened"}`);
  editor.before.set(store.pins.at(-1)!.model);
}

/** Forget a pinned state; what was compared with it is compared with the opening. */
export function unpin({ store, before }: EditorController, index: number): void {
  const gone = store.pins[index]?.model;
  store.unpin(index);
  if (before.peek() === gone) before.set(store.history.opening);
}
