/** The editor of the page that a component stands in. */

import { createContext } from "svelte";
import type { EditorController } from "./editor_controller";

export const [editorHere, provideEditor] = createContext<EditorController>();
