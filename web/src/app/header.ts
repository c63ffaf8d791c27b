/** What pages add to the header. */

import { signal } from "../ui";

/** Parts of pages that stay in the header, such as a job that runs. */
export const headerExtras = signal<readonly HTMLElement[]>([]);
