/** The tour is loaded when it is wanted. */

import { tell } from "../../ui/toast";

export function startTour(): void {
  import("./tour").then(({ tour }) => tour(), tell);
}
