/** The card of who sits here: in memory and in this tab's sessionStorage only, so that a reload finds the way back. */

export interface Card {
  readonly person: string;
  readonly code: string;
  readonly language: string;
  /** The person has written it down. */
  readonly noted: boolean;
}

/** Of a seat: another link in the same tab is another person. */
const key = (study: string, seat: string) => `fdvv-study:${study}:${seat}`;

export function keptCard(study: string, seat: string): Card | null {
  const text = sessionStorage.getItem(key(study, seat));
  return text ? (JSON.parse(text) as Card) : null;
}

export function keepCard(study: string, seat: string, card: Card | null): void {
  if (card) sessionStorage.setItem(key(study, seat), JSON.stringify(card));
  else sessionStorage.removeItem(key(study, seat));
}
