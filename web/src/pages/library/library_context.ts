/** What the library knows, for the components of its page. */

import { createContext } from "svelte";
import type { LibraryStore } from "./store";

export const [libraryHere, provideLibrary] = createContext<LibraryStore>();
