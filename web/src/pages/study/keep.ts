/** The card of who sits here: in memory and in this tab's sessionStorage only, so that a reload finds the way back. */

export interface Card {
  readonly person: string;
  readonly code: string;
  readonly language: string;
  /** The person has written it down. */
  readonly noted: boolean;
}

const holderKey = (study: string, seat: string) => `fdvv-holder:${study}:${seat}`;

/** The secret by which only this tab uses an invitation: others who see the link cannot use it. */
export function holder(study: string, seat: string): string {
  const known = sessionStorage.getItem(holderKey(study, seat));
  if (known) return known;
  // randomUUID is only there where a page came encrypted or from this machine
  const drawn = [...crypto.getRandomValues(new Uint8Array(16))]
    .map((byte) => byte.toString(16).padStart(2, "0"))
    .join("");
  sessionStorage.setItem(holderKey(study, seat), drawn);
  return drawn;
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

/** The session is over: nothing of it stays in this tab. */
export function forget(study: string, seat: string): void {
  keepCard(study, seat, null);
  sessionStorage.removeItem(holderKey(study, seat));
}
