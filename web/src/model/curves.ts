/** Edits of whole curves: assign, copy, remove, another velocity; the rules are those of `fdvv.model._edit`. */

import { g, ModelError, type Spline, type Stroke, speed, splice } from "../math";
import type { Edit } from "./edit";
import { curveAt, foundCurve, isAt, label, withCurve } from "./model";
import type { CurveRef, FDVVModel, ForceCurve } from "./types";

/** Which part of a curve goes into another, and how wide the join is. */
export interface Segment {
  /** Start and end. */
  readonly segment_mm: readonly [number, number];
  /** Width beyond either end over which one cubic leads from the old curve to the new. */
  readonly blend_mm?: number;
}

/**
 * Return a model a curve, or a segment of one, as its press or release at a velocity.
 *
 * A whole curve that goes where it was measured keeps its spread; elsewhere, or with a segment of another curve
 * in it, it was never measured and has none.
 */
export function assignCurve(curve: ForceCurve, to: CurveRef, segment?: Segment): Edit {
  return {
    label: `assign ${label(curve)} to ${label(to)}`,
    change: (model) => assigned(model, curve, to, segment),
  };
}

function assigned(model: FDVVModel, curve: ForceCurve, to: CurveRef, segment?: Segment): FDVVModel {
  const { stroke, velocity_mm_s } = to;
  const [a, b] = segment?.segment_mm ?? [0, 0];
  const span = segment ? ` from ${g(a)} to ${g(b)} mm` : "";
  const placed = segment
    ? { ...to, ...numbers(splice(foundCurve(model, to), curve, segment.segment_mm, segment.blend_mm)) }
    : moved(curve, to);
  const made = withCurve(model, { ...placed, stroke, velocity_mm_s });
  return methodNoted(made, `${label(to)}${span} assigned from ${label(curve)}`);
}

/** Place a whole curve; away from where it was measured it has no spread. */
function moved(curve: ForceCurve, to: CurveRef): ForceCurve {
  const { spread: _spread, ...drawn } = curve;
  return isAt(curve, to) ? curve : { ...drawn, stroke: to.stroke, velocity_mm_s: to.velocity_mm_s };
}

function numbers({ degree, knots_mm, control_points_cN }: Spline) {
  return {
    degree,
    knots_mm: Array.from(knots_mm, (x) => x + 0),
    control_points_cN: Array.from(control_points_cN, (c) => c + 0),
  };
}

/** Copy a curve of the model to another stroke or velocity, replacing what is there. */
export function copyCurve(from: CurveRef, to: CurveRef): Edit {
  return {
    label: `copy ${label(from)} to ${label(to)}`,
    change: (model) => assigned(model, foundCurve(model, from), to),
  };
}

/** Put a segment of one curve of the model into another. */
export function copySegment(from: CurveRef, to: CurveRef, segment: Segment): Edit {
  const [a, b] = segment.segment_mm;
  return {
    label: `copy ${g(a)} to ${g(b)} mm of ${label(from)} to ${label(to)}`,
    change: (model) => assigned(model, foundCurve(model, from), to, segment),
  };
}

/** Remove a curve; vibrations stay. Refused if it is the last one. */
export function removeCurve(at: CurveRef): Edit {
  return {
    label: `remove ${label(at)}`,
    change: (model) => {
      const gone = foundCurve(model, at);
      if (model.curves.length === 1) {
        throw new ModelError(`the ${label(gone)} is the only curve of '${model.name}'; a model needs one`);
      }
      return methodNoted(
        { ...model, curves: model.curves.filter((c) => c !== gone) },
        `${label(gone)} removed`,
      );
    },
  };
}

/** Say that a curve is of another velocity or stroke; refused if there is one already. */
export function moveCurve(from: CurveRef, to: CurveRef): Edit {
  return {
    label: `move ${label(from)} to ${label(to)}`,
    change: (model) => {
      const curve = foundCurve(model, from);
      if (isAt(from, to)) return model;
      if (curveAt(model, to)) {
        throw new ModelError(
          `there is a ${to.stroke} curve at ${speed(to.velocity_mm_s)} already; remove it first`,
        );
      }
      const curves = model.curves.map((c) => (c === curve ? moved(c, to) : c));
      return methodNoted({ ...model, curves }, `${label(from)} moved to ${label(to)}`);
    },
  };
}

/** Say at which velocity a curve is; null if it is unknown. */
export function setVelocity(at: CurveRef, velocity_mm_s: number | null): Edit {
  return moveCurve(at, { stroke: at.stroke, velocity_mm_s });
}

/** Use the curves of one stroke for the other too, replacing what is there. */
export function copyStroke(from: Stroke, to: Stroke): Edit {
  return {
    label: `copy the ${from} curves to the ${to}`,
    change: (model) => {
      const kept = model.curves.filter((c) => c.stroke !== to);
      const start = { ...model, curves: kept.length ? kept : model.curves };
      return model.curves
        .filter((c) => c.stroke === from)
        .reduce((now, c) => assigned(now, c, { stroke: to, velocity_mm_s: c.velocity_mm_s }), start);
    },
  };
}

function methodNoted(model: FDVVModel, note: string): FDVVModel {
  const { provenance } = model;
  const method = provenance.method ? `${provenance.method}; ${note}` : note;
  return { ...model, provenance: { ...provenance, method } };
}
