/** Plane geometry of the graph, in its own pixels: x to the right, y down. */

export interface Point {
  readonly x: number;
  readonly y: number;
}

/** An upright rectangle by its upper left corner. */
export interface Box {
  readonly x: number;
  readonly y: number;
  readonly width: number;
  readonly height: number;
}

/** A cubic Bézier curve by its four control points. */
export type Cubic = readonly [Point, Point, Point, Point];

export function boxAround(centre: Point, width: number, height: number): Box {
  return { x: centre.x - width / 2, y: centre.y - height / 2, width, height };
}

export function centreOf(box: Box): Point {
  return { x: box.x + box.width / 2, y: box.y + box.height / 2 };
}

export function moveBox(box: Box, by: Point): Box {
  return { ...box, x: box.x + by.x, y: box.y + by.y };
}

/** Whether two boxes are nearer to each other than `gap`. */
export function overlap(a: Box, b: Box, gap = 0): boolean {
  return (
    a.x < b.x + b.width + gap &&
    b.x < a.x + a.width + gap &&
    a.y < b.y + b.height + gap &&
    b.y < a.y + a.height + gap
  );
}

/** Whether a point is inside a box grown by `margin`. */
export function contains(box: Box, at: Point, margin = 0): boolean {
  return (
    at.x > box.x - margin &&
    at.x < box.x + box.width + margin &&
    at.y > box.y - margin &&
    at.y < box.y + box.height + margin
  );
}

/** Return the smallest box around boxes, empty around none. */
export function boundsOf(boxes: readonly Box[]): Box {
  if (boxes.length === 0) return { x: 0, y: 0, width: 0, height: 0 };
  const x = Math.min(...boxes.map((box) => box.x));
  const y = Math.min(...boxes.map((box) => box.y));
  const right = Math.max(...boxes.map((box) => box.x + box.width));
  const bottom = Math.max(...boxes.map((box) => box.y + box.height));
  return { x, y, width: right - x, height: bottom - y };
}

/** Return the point of a box's border on the way from its centre to a point outside. */
export function borderPoint(box: Box, towards: Point): Point {
  const centre = centreOf(box);
  const [dx, dy] = [towards.x - centre.x, towards.y - centre.y];
  const ratio = 1 / Math.max((2 * Math.abs(dx)) / box.width, (2 * Math.abs(dy)) / box.height, 1);
  return { x: centre.x + dx * ratio, y: centre.y + dy * ratio };
}

/** Return a smooth curve through points: Catmull-Rom, with tangents short enough not to overshoot. */
export function splineThrough(points: readonly Point[]): readonly Cubic[] {
  const handles = points.map((at, i) => {
    const [before, after] = [points[i - 1], points[i + 1]];
    if (!before || !after) return { x: 0, y: 0 };
    const length = Math.hypot(after.x - before.x, after.y - before.y) || 1;
    const reach = Math.min(
      Math.hypot(at.x - before.x, at.y - before.y),
      Math.hypot(after.x - at.x, after.y - at.y),
    );
    const scale = reach / 3 / length;
    return { x: (after.x - before.x) * scale, y: (after.y - before.y) * scale };
  });
  return points.slice(1).map((end, i) => {
    const [start, from, to] = [points[i]!, handles[i]!, handles[i + 1]!];
    return [start, { x: start.x + from.x, y: start.y + from.y }, { x: end.x - to.x, y: end.y - to.y }, end];
  });
}

/** Return the `d` of an SVG path through points. */
export function svgPath(points: readonly Point[]): string {
  const text = (at: Point): string => `${at.x.toFixed(1)} ${at.y.toFixed(1)}`;
  const curves = splineThrough(points).map(([, b, c, d]) => `C${text(b)} ${text(c)} ${text(d)}`);
  return `M${text(points[0]!)}${curves.join("")}`;
}
