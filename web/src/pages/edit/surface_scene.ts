/** The geometry of the surface view: a box of displacement, velocity and force, turned and seen from afar. */

/** A place in the box, each from -1 to 1: displacement to the right, velocity backwards, force upwards. */
export type Corner = readonly [right: number, back: number, up: number];

/** How the box is turned: about the upright axis, then tilted towards the eye; radians. */
export interface Turn {
  readonly around_rad: number;
  readonly tilt_rad: number;
}

/** The view it begins with. */
export const FIRST_TURN: Turn = { around_rad: -0.65, tilt_rad: 0.5 };

/** A place on the picture, y downward, and how far behind the middle it is. */
export interface Seen {
  readonly x: number;
  readonly y: number;
  readonly behind: number;
}

/** Where a corner is seen, the whole box always within -1.8 to 1.8; parallel, so that lengths can be compared. */
export function seen([right, back, up]: Corner, turn: Turn): Seen {
  const [cos, sin] = [Math.cos(turn.around_rad), Math.sin(turn.around_rad)];
  const [x, depth] = [right * cos - back * sin, right * sin + back * cos];
  const [c, s] = [Math.cos(turn.tilt_rad), Math.sin(turn.tilt_rad)];
  return { x, y: -(up * c + depth * s), behind: depth * c - up * s };
}

/** A turn by an amount, the tilt held between flat and from above. */
export function turned(turn: Turn, around_rad: number, tilt_rad: number): Turn {
  const tilt = Math.min(Math.PI / 2, Math.max(0, turn.tilt_rad + tilt_rad));
  return { around_rad: turn.around_rad + around_rad, tilt_rad: tilt };
}

/** One face of a grid of heights: row and column of its near corner, and how far behind it lies. */
export interface Face {
  readonly row: number;
  readonly column: number;
  readonly behind: number;
}

/**
 * The faces of a grid from the farthest to the nearest, to be painted in this order.
 *
 * @param corners - rows of velocities, each with the same number of displacements, as they are seen.
 */
export function facesFromBehind(corners: readonly (readonly Seen[])[]): Face[] {
  const faces: Face[] = [];
  for (let row = 0; row + 1 < corners.length; row++) {
    const [near, far] = [corners[row]!, corners[row + 1]!];
    for (let column = 0; column + 1 < near.length; column++) {
      const behind =
        near[column]!.behind + near[column + 1]!.behind + far[column]!.behind + far[column + 1]!.behind;
      faces.push({ row, column, behind: behind / 4 });
    }
  }
  return faces.sort((a, b) => b.behind - a.behind);
}

/** The bottom edges of the box that lie in front, where axes are written: which end of the other axis each is at. */
export function frontEdges(turn: Turn): {
  readonly displacementAtBack: -1 | 1;
  readonly velocityAtRight: -1 | 1;
} {
  const behind = (right: number, back: number): number => seen([right, back, -1], turn).behind;
  return {
    displacementAtBack: behind(0, -1) < behind(0, 1) ? -1 : 1,
    velocityAtRight: behind(-1, 0) < behind(1, 0) ? -1 : 1,
  };
}
