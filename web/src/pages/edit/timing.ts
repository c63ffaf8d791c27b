/** How long the page works for one move of the hand; benchmarks/studio_drag.py reads these measures. */

/** Run work and leave its duration as a measure of the browser. */
export function timed(name: "fdvv-hand" | "fdvv-draw", work: () => void): void {
  const start = performance.now();
  work();
  performance.measure(name, { start, end: performance.now() });
  performance.clearMeasures(name);
}
