/** Merge models into one FDVV model by the rules of `fdvv.model.merge`. */

import { type Interpolation, ModelError } from "../math";
import type { Edit } from "./edit";
import { isAt, label, same } from "./model";
import type { CurveRef, FDVVModel, PointSpread, Provenance } from "./types";

/** What a merge does with two different curves, or vibrations, of one stroke and velocity. */
export type Conflict = "refuse" | "first" | "last";

export const CONFLICTS: readonly Conflict[] = ["refuse", "first", "last"];

/** What decides where models differ. */
export interface MergeOptions {
  readonly conflict?: Conflict;
  readonly travel_mm?: number;
  readonly actuation_mm?: number;
  readonly reset_mm?: number;
  readonly interpolation?: Interpolation;
}

interface Part extends CurveRef {
  readonly spread?: unknown;
}

type Stated<Value> = readonly (readonly [string, Value | null])[];

/** Take the curves and vibrations of other models into the edited one, whose name stays. */
export function mergeModels(others: readonly FDVVModel[], options: MergeOptions = {}): Edit {
  return {
    label: `merge ${others.map((model) => model.name).join(", ")}`,
    change: (model) => merge([model, ...others], model.name, options),
  };
}

/** Merge models: equal curves count once, and the one that knows its spread is kept. Throws ModelError. */
export function merge(models: readonly FDVVModel[], name: string, options: MergeOptions = {}): FDVVModel {
  const stated = <K extends "travel_mm" | "actuation_mm" | "reset_mm" | "interpolation">(what: K) =>
    decided(
      what,
      options[what] as FDVVModel[K] | undefined,
      models.map((m) => [m.name, m[what]] as const),
    );
  const travel_mm = stated("travel_mm");
  if (travel_mm === null) throw new ModelError("a merge needs at least one curve or model, got none");
  const [actuation_mm, reset_mm] = [stated("actuation_mm"), stated("reset_mm")];
  const rule = options.conflict ?? "refuse";
  return {
    format: "fdvv-model",
    version: 1,
    name,
    travel_mm,
    actuation_mm,
    reset_mm,
    interpolation: stated("interpolation") ?? "pchip",
    curves: settled(
      "curve",
      models.flatMap((m) => m.curves.map((c) => [m.name, c] as const)),
      rule,
    ),
    vibrations: settled(
      "vibration",
      models.flatMap((m) => m.vibrations.map((v) => [m.name, v] as const)),
      rule,
    ),
    provenance: joined(
      models.map((m) => m.provenance),
      `merged from ${models.map((m) => m.name).join(", ")}`,
    ),
    ...mergedNumber("travel", travel_mm, models),
    ...mergedNumber("actuation", actuation_mm, models),
    ...mergedNumber("reset", reset_mm, models),
  };
}

/** Take what is given, else the one value that everyone who knows it states. */
function decided<Value>(what: string, given: Value | undefined, stated: Stated<Value>): Value | null {
  if (given !== undefined) return given;
  const known = stated.filter(([, value]) => value !== null);
  for (const [who, value] of known) {
    const [first, there] = known[0]!;
    if (value !== there) {
      const sides = `${there} in '${first}' and ${value} in '${who}'`;
      throw new ModelError(`parts differ in ${what}: ${sides}; pass ${what} to decide`);
    }
  }
  return known[0]?.[1] ?? null;
}

/** Keep one part per stroke and velocity, by the rule where two differ. */
function settled<P extends Part>(
  what: string,
  parts: readonly (readonly [string, P])[],
  rule: Conflict,
): P[] {
  const kept: (readonly [string, P])[] = [];
  for (const [who, part] of parts) {
    const index = kept.findIndex(([, there]) => isAt(there, part));
    if (index < 0) {
      kept.push([who, part]);
      continue;
    }
    const [earlier, there] = kept[index]!;
    const alike = same({ ...there, spread: null }, { ...part, spread: null });
    if (alike && (!there.spread || !part.spread)) kept[index] = there.spread ? kept[index]! : [who, part];
    else if (alike && same(there.spread, part.spread)) continue;
    else if (rule === "refuse") {
      const sides = `one from '${earlier}', one from '${who}'`;
      throw new ModelError(
        `two different ${what}s for ${label(part)}, ${sides}; choose first or last to decide`,
      );
    } else if (rule === "last") kept[index] = [who, part];
  }
  return kept.map(([, part]) => part);
}

/** Return the spread of a point from those who state it at that very place; none if they differ in it. */
function mergedNumber(
  point: "travel" | "actuation" | "reset",
  place_mm: number | null,
  models: readonly FDVVModel[],
) {
  const found: PointSpread[] = [];
  for (const model of models) {
    const spread = model[`${point}_spread`];
    if (spread && model[`${point}_mm`] === place_mm && !found.some((s) => same(s, spread)))
      found.push(spread);
  }
  return found.length === 1 ? { [`${point}_spread`]: found[0]! } : {};
}

/** Join provenances, each statement once, and add a note to the method. */
function joined(provenances: readonly Provenance[], note: string): Provenance {
  const once = (texts: readonly string[]) => [...new Set(texts.filter(Boolean))];
  return {
    source: once(provenances.map((p) => p.source)).join("; "),
    licence: once(provenances.map((p) => p.licence)).join("; "),
    citation: once(provenances.map((p) => p.citation)).join("; "),
    method: [...once(provenances.map((p) => p.method)), note].join("; "),
    assumptions: once(provenances.flatMap((p) => p.assumptions)),
    simulated: provenances.some((p) => p.simulated),
  };
}
