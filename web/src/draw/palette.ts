/** The colours of the page as drawings need them: read from the style sheet, anew when the theme changes. */

import { signal } from "../ui/signal.svelte";

export interface Palette {
  readonly text: string;
  readonly muted: string;
  readonly grid: string;
  readonly surface: string;
  readonly accent: string;
  readonly warning: string;
  readonly danger: string;
  readonly good: string;
  /** Eight colours that people with any kind of colour vision tell apart; always used with SERIES_DASH. */
  readonly series: readonly string[];
  /** Stops of the scale of velocity, slow to fast; read them by velocityColour. */
  readonly velocity: readonly string[];
}

/** The dash of every release, wherever both strokes are drawn. */
export const RELEASE_DASH: readonly number[] = [6, 4];

/** Dashes that go with the series colours, so that colour is never the only difference. */
const SERIES_DASH: readonly (readonly number[])[] = [
  [],
  [7, 3],
  [2, 3],
  [9, 3, 2, 3],
  [14, 4],
  [4, 4],
  [9, 3, 2, 3, 2, 3],
  [1, 4],
];

function read(): Palette {
  const style = getComputedStyle(document.documentElement);
  const colour = (name: string) => style.getPropertyValue(`--${name}`).trim();
  return {
    text: colour("text"),
    muted: colour("muted"),
    grid: colour("grid"),
    surface: colour("surface"),
    accent: colour("accent"),
    warning: colour("warning"),
    danger: colour("danger"),
    good: colour("good"),
    series: Array.from({ length: 8 }, (_, i) => colour(`series-${i + 1}`)),
    velocity: Array.from({ length: 5 }, (_, i) => colour(`velocity-${i + 1}`)),
  };
}

const current = signal<Palette | null>(null);

/** Return the colours of now; an effect that reads them runs again when the theme changes. */
export function palette(): Palette {
  return current() ?? refreshPalette();
}

/** Read the style sheet again: the theme has changed. */
export function refreshPalette(): Palette {
  const found = read();
  current.set(found);
  return found;
}

/** Return the colour and dash of the n-th series. */
export function series(n: number): { readonly colour: string; readonly dash: readonly number[] } {
  const colours = palette().series;
  return {
    colour: colours[n % colours.length] as string,
    dash: SERIES_DASH[n % SERIES_DASH.length] as number[],
  };
}
