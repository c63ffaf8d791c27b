/** A recording played as if its reports came now. */

import type { Recording } from "./recording";

/** How often it is looked which reports are due; what came between two looks keeps its own time. */
const LOOK_ms = 4;
/** Between two rounds of one that is repeated. */
const PAUSE_ms = 300;

/** Play from now on; read is called with times of the page's clock. The function returned stops it. */
export function play(
  { t_ms, depth_mm }: Recording,
  read: (at_ms: number, depth_mm: number) => void,
  repeat: () => boolean,
  over: () => void,
): () => void {
  let [start_ms, next] = [performance.now(), 0];
  const timer = setInterval(() => {
    const since_ms = performance.now() - start_ms;
    for (; next < t_ms.length && (t_ms[next] as number) <= since_ms; next++)
      read(start_ms + (t_ms[next] as number), depth_mm[next] as number);
    if (next < t_ms.length) return;
    if (repeat()) [start_ms, next] = [performance.now() + PAUSE_ms, 0];
    else {
      clearInterval(timer);
      over();
    }
  }, LOOK_ms);
  return () => clearInterval(timer);
}
