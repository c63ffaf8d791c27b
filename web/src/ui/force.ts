/** The unit in which forces are shown and typed; models, files and messages hold cN. */

import { type Signal, signal } from "./signal.svelte";

export type ForceUnit = "cN" | "gf" | "N";

const KEPT = "fdvv-force-unit";
/** So much of a unit is 1 cN; 1 gf is 0.980665 cN. */
const PER_cN: Readonly<Record<ForceUnit, number>> = { cN: 1, gf: 1 / 0.980665, N: 0.01 };
const UNITS = Object.keys(PER_cN) as ForceUnit[];
/** One force or several that share their unit, such as "98.1 → 4.0 cN" or "8 and 11 cN". */
const FORCES = /[−-]?\d+(?:\.\d+)?(?:(?: (?:and|to|→|±|\+-|against) |, |\/)[−-]?\d+(?:\.\d+)?)* cN\b/g;
const NUMBER = /[−-]?\d+(?:\.\d+)?/g;

export const forceUnit: Signal<ForceUnit> = signal<ForceUnit>("cN");

/** Take the unit that this browser remembers. */
export function rememberForceUnit(): void {
  forceUnit.set(UNITS.find((one) => one === localStorage.getItem(KEPT)) ?? "cN");
}

export function nextForceUnit(): void {
  forceUnit.update((now) => UNITS[(UNITS.indexOf(now) + 1) % UNITS.length]!);
  localStorage.setItem(KEPT, forceUnit.peek());
}

/** Return how much of the unit shown is 1 of this one: 1 where it holds no force. */
export function perUnit(unit: string): number {
  return /^cN\b/.test(unit) ? PER_cN[forceUnit()] : 1;
}

/** Return the unit that is shown for one that may hold a force, such as "cN/mm". */
export function unitText(unit: string): string {
  return unit.replace(/^cN\b/, forceUnit());
}

/** Return the decimals that show as much as `digits` do of this unit. */
export function digitsOf(unit: string, digits: number): number {
  return perUnit(unit) < 0.1 ? digits + 2 : digits;
}

/** Write a number of a unit in the one that is shown, without its name. */
export function inUnit(value: number, unit: string, digits: number): string {
  return (value * perUnit(unit)).toFixed(digitsOf(unit, digits)).replace("-", "−");
}

/** Write a force with its unit. */
export function force(force_cN: number, digits = 1): string {
  return `${inUnit(force_cN, "cN", digits)} ${forceUnit()}`;
}

/** Return a sentence of the server, whose forces are in cN, with those that are shown. */
export function withForces(sentence: string): string {
  if (forceUnit() === "cN") return sentence;
  return sentence.replace(FORCES, (forces) => {
    const numbers = forces.slice(0, -" cN".length);
    return `${numbers.replace(NUMBER, inShownUnit)} ${forceUnit()}`;
  });
}

function inShownUnit(number: string): string {
  const decimals = number.split(".")[1]?.length ?? 0;
  return inUnit(Number(number.replace("−", "-")), "cN", decimals);
}
