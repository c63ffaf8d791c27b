/** Where the states stand: columns by their distance from the start, rows by who leads to whom. */

import { transitionsOf } from "../document";
import type { ProgramDocument } from "../document";
import type { Point } from "./geometry";

/** Size of a state's node, and how far apart columns and rows are. */
export const NODE = { width: 124, height: 54 } as const;
export const PITCH = { x: NODE.width + 140, y: NODE.height + 80 } as const;
/** The shape of the place that a graph usually has, width over height. */
const ASPECT = 1.6;
const MOST_IN_COLUMN = 6;
const SWEEPS = 4;

/** Give the centre of every state by its name; deterministic, the start on the left. */
export function placesOf(document: ProgramDocument): ReadonlyMap<string, Point> {
  const columns = columnsOf(document);
  const bands = folded(columns, bestFold(columns));
  const found = new Map<string, Point>();
  let top = 0;
  bands.forEach((band, turn) => {
    const rows = tallest(band);
    band.forEach((names, i) => {
      // every other band goes back, so that what follows each other stays beside each other
      const column = turn % 2 === 0 ? i : bands[0]!.length - 1 - i;
      const first = top + ((rows - names.length) / 2) * PITCH.y;
      names.forEach((name, row) => found.set(name, { x: column * PITCH.x, y: first + row * PITCH.y }));
    });
    top += rows * PITCH.y;
  });
  return found;
}

type Columns = readonly (readonly string[])[];

function tallest(columns: Columns): number {
  return Math.max(1, ...columns.map((names) => names.length));
}

function folded(columns: Columns, size: number): readonly Columns[] {
  const count = Math.max(1, Math.ceil(columns.length / size));
  return Array.from({ length: count }, (_, i) => columns.slice(i * size, (i + 1) * size));
}

/** Find how many columns stand beside each other so that the whole is seen largest, at least three. */
function bestFold(columns: Columns): number {
  const extent = (size: number): number => {
    const height = folded(columns, size).reduce((sum, band) => sum + tallest(band) * PITCH.y, 0);
    return Math.max(size * PITCH.x, height * ASPECT);
  };
  let best = Math.max(1, columns.length);
  for (let size = best - 1; size >= 3; size -= 1) if (extent(size) < extent(best)) best = size;
  return best;
}

function columnsOf(document: ProgramDocument): Columns {
  const ways = new Map(document.states.map((state) => [state.name, transitionsOf(state).map((way) => way.to)]));
  const layers = sorted(layersOf(document, ways), ways);
  return layers.flatMap((names) => split(names));
}

/** Group states by how many ways lead from the start to them; unreachable ones come last. */
function layersOf(document: ProgramDocument, ways: ReadonlyMap<string, readonly string[]>): string[][] {
  const seen = new Set(ways.has(document.start) ? [document.start] : []);
  const layers: string[][] = seen.size > 0 ? [[document.start]] : [];
  for (let layer = layers[0]; layer && layer.length > 0; ) {
    const next = [...new Set(layer.flatMap((name) => ways.get(name) ?? []))].filter(
      (name) => ways.has(name) && !seen.has(name),
    );
    for (const name of next) seen.add(name);
    if (next.length > 0) layers.push(next);
    layer = next;
  }
  const left = [...ways.keys()].filter((name) => !seen.has(name));
  return left.length > 0 ? [...layers, left] : layers;
}

/** Order each layer by the mean row of its neighbours in the layers beside it, back and forth. */
function sorted(layers: string[][], ways: ReadonlyMap<string, readonly string[]>): string[][] {
  const beside = new Map<string, string[]>();
  for (const [from, targets] of ways)
    for (const to of targets) {
      beside.set(from, [...(beside.get(from) ?? []), to]);
      beside.set(to, [...(beside.get(to) ?? []), from]);
    }
  let found = layers;
  for (let sweep = 0; sweep < SWEEPS; sweep += 1) {
    const rows = rowsOf(found);
    found = found.map((names) => {
      const weight = new Map(names.map((name) => [name, meanRow(name, beside.get(name) ?? [], rows)]));
      return [...names].sort((a, b) => weight.get(a)! - weight.get(b)!);
    });
  }
  return found;
}

function rowsOf(layers: readonly (readonly string[])[]): ReadonlyMap<string, number> {
  return new Map(layers.flatMap((names) => names.map((name, i) => [name, i - (names.length - 1) / 2] as const)));
}

function meanRow(name: string, beside: readonly string[], rows: ReadonlyMap<string, number>): number {
  const found = [name, ...beside].map((held) => rows.get(held) ?? 0);
  return found.reduce((sum, row) => sum + row, 0) / found.length;
}

/** A layer of many states takes several columns. */
function split(names: readonly string[]): string[][] {
  const count = Math.ceil(names.length / MOST_IN_COLUMN);
  const size = Math.ceil(names.length / count);
  return Array.from({ length: count }, (_, i) => names.slice(i * size, (i + 1) * size));
}
