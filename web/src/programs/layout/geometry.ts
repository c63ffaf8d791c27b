/** Plane geometry of the graph, in its own pixels: x to the right, y down. */

/** A place in the graph. */
export interface Point {
  readonly x: number;
  readonly y: number;
}

/** An upright rectangle by its left upper corner. */
export interface Box {
  readonly x: number;
  readonly y: number;
  readonly width: number;
  readonly height: number;
}

/** A cubic curve by its four points. */
export type Cubic = readonly [Point, Point, Point, Point];

/** Make a box of a size around a place. */
export function boxAround(centre: Point, width: number, height: number): Box {
  return { x: centre.x - width / 2, y: centre.y - height / 2, width, height };
}

/** Give the middle of a box. */
export function centreOf(box: Box): Point {
  return { x: box.x + box.width / 2, y: box.y + box.height / 2 };
}

/** Tell whether two boxes come nearer to each other than a gap. */
export function overlap(a: Box, b: Box, gap = 0): boolean {
  return (
    a.x < b.x + b.width + gap &&
    b.x < a.x + a.width + gap &&
    a.y < b.y + b.height + gap &&
    b.y < a.y + a.height + gap
  );
}

/** Tell whether a place lies in a box grown by a margin. */
export function holds(box: Box, at: Point, margin = 0): boolean {
  return (
    at.x > box.x - margin &&
    at.x < box.x + box.width + margin &&
    at.y > box.y - margin &&
    at.y < box.y + box.height + margin
  );
}

/** Give the smallest box around boxes, empty around none. */
export function around(boxes: readonly Box[]): Box {
  if (boxes.length === 0) return { x: 0, y: 0, width: 0, height: 0 };
  const x = Math.min(...boxes.map((box) => box.x));
  const y = Math.min(...boxes.map((box) => box.y));
  const right = Math.max(...boxes.map((box) => box.x + box.width));
  const bottom = Math.max(...boxes.map((box) => box.y + box.height));
  return { x, y, width: right - x, height: bottom - y };
}

/** Evaluate a cubic curve, t from 0 to 1. */
export function onCubic([a, b, c, d]: Cubic, t: number): Point {
  const s = 1 - t;
  const weights = [s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t] as const;
  return {
    x: weights[0] * a.x + weights[1] * b.x + weights[2] * c.x + weights[3] * d.x,
    y: weights[0] * a.y + weights[1] * b.y + weights[2] * c.y + weights[3] * d.y,
  };
}

/** Give places along a curve, both ends included. */
export function samplesOf(curve: Cubic, count: number): readonly Point[] {
  return Array.from({ length: count }, (_, i) => onCubic(curve, i / (count - 1)));
}

/** Cut a curve to the part between two of its parameters. */
export function cut(curve: Cubic, from: number, to: number): Cubic {
  const slope = (t: number): Point => {
    const [a, b, c, d] = curve;
    const s = 1 - t;
    const along = (key: "x" | "y"): number =>
      3 * s * s * (b[key] - a[key]) + 6 * s * t * (c[key] - b[key]) + 3 * t * t * (d[key] - c[key]);
    return { x: along("x"), y: along("y") };
  };
  const third = (to - from) / 3;
  const [start, end, leaving, arriving] = [onCubic(curve, from), onCubic(curve, to), slope(from), slope(to)];
  return [
    start,
    { x: start.x + leaving.x * third, y: start.y + leaving.y * third },
    { x: end.x - arriving.x * third, y: end.y - arriving.y * third },
    end,
  ];
}

/** Write a curve as the `d` of an SVG path. */
export function pathOfCubic([a, b, c, d]: Cubic): string {
  const told = (at: Point): string => `${at.x.toFixed(1)} ${at.y.toFixed(1)}`;
  return `M${told(a)}C${told(b)} ${told(c)} ${told(d)}`;
}
