/** Drags of one curve that the curves of its stroke at other speeds follow by the same force. */

import { type Constraints, controlPoints_mm } from "../../math";
import { type Edit, type ForceCurve, type PointsRef, together } from "../../model";
import { refOf } from "./editor_controller";
import { bumpHandles, pullEdit } from "./handles";

/** The curve that is dragged, and those that follow it. */
export interface Dragged {
  readonly curve: ForceCurve;
  readonly followers: readonly ForceCurve[];
}

/** The points that move: those of the dragged curve, and on each follower the nearest to every one of them. */
export function pointsToMove({ curve, followers }: Dragged, indices: readonly number[]): PointsRef[] {
  const at_mm = controlPoints_mm(curve);
  const here: PointsRef = { ...refOf(curve), indices };
  return [
    here,
    ...followers.map((other) => {
      const others_mm = controlPoints_mm(other);
      return { ...refOf(other), indices: [...new Set(indices.map((i) => nearest(others_mm, at_mm[i]!)))] };
    }),
  ];
}

/** The edit that pulls all of them at a place by a force; a peak or valley is pulled where each has its own. */
export function pullAll(
  { curve, followers }: Dragged,
  x_mm: number,
  by_cN: number,
  { constraints, bump, travel_mm }: PullOptions,
): Edit {
  const own = pullEdit(curve, x_mm, by_cN, constraints);
  if (!followers.length) return own;
  const place = (other: ForceCurve) =>
    bumpHandles(other, travel_mm).find(({ name }) => name === bump)?.x_mm ?? x_mm;
  const theirs = followers.map((other) => pullEdit(other, place(other), by_cN, constraints));
  return together(`pull every speed of ${curve.stroke}`, [own, ...theirs]);
}

interface PullOptions {
  readonly constraints: Constraints;
  readonly travel_mm: number;
  /** Which of its bumps is pulled, if one is. */
  readonly bump?: string | undefined;
}

function nearest(all_mm: ArrayLike<number>, x_mm: number): number {
  let best = 0;
  for (let i = 1; i < all_mm.length; i++)
    if (Math.abs(all_mm[i]! - x_mm) < Math.abs(all_mm[best]! - x_mm)) best = i;
  return best;
}
