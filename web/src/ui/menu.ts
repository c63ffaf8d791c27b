/** An entry of a menu: its name, and what it does. */
export type Action = readonly [string, () => void];
