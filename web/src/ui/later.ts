/** When an effect runs that need not run at once. */

/** Return the `later` of an effect whose work may wait until the next frame is painted; it runs once for all changes. */
export function afterPaint(): (run: () => void) => void {
  let waits = false;
  return (run) => {
    if (waits) return;
    waits = true;
    const now = () => {
      waits = false;
      run();
    };
    requestAnimationFrame(() => setTimeout(now));
  };
}
