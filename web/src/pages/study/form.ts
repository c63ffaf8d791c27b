/** What is filled in on a page outside the trials, as the server takes it. */

import type { StudyAsked } from "../../net/messages";

/** Whether a number is asked for. */
export function isNumber({ choices, low, high }: StudyAsked): boolean {
  return !choices.length && (low !== null || high !== null);
}

/** Read what was typed or chosen: null if nothing need be, undefined if that will not do. */
export function read(asked: StudyAsked, text: string): string | number | null | undefined {
  const typed = asked.choices.length ? text : text.trim();
  if (!typed) return asked.required ? undefined : null;
  return isNumber(asked) ? inRange(Number(typed.replace(",", ".")), asked) : typed;
}

function inRange(value: number, { low, high }: StudyAsked): number | undefined {
  return Number.isFinite(value) && value >= (low ?? -Infinity) && value <= (high ?? Infinity)
    ? value
    : undefined;
}
