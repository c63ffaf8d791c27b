/** What a plot shows, and what its layers draw with. */

import type { Box, Brush } from "./brush";
import type { Range, Scale } from "./scale";

export interface Axis {
  readonly label: string;
  readonly unit: string;
}

/** What a layer needs to know to draw. */
export interface View {
  readonly x: Scale;
  readonly y: Scale;
  /** The inside of the axes, px. */
  readonly box: Box;
  readonly width_px: number;
  readonly height_px: number;
}

export type Layer = (brush: Brush, view: View) => void;

/** A name at the end of a curve. */
export interface EndLabel {
  readonly text: string;
  readonly colour: string;
  /** Where the curve ends, in the plot's units. */
  readonly x: number;
  readonly y: number;
  /** Those that matter most keep their place where room is short. */
  readonly weight?: number;
  readonly opacity?: number;
}

export interface PlotOptions {
  /** Says what the plot shows to those who do not see it. */
  readonly label: string;
  readonly x: Axis;
  readonly y: Axis;
  /** Everything there is to see; what Fit goes back to. */
  readonly whole: () => { readonly x: Range; readonly y: Range };
  /** Drawn when what it reads changes, or the view does. */
  readonly still?: Layer;
  /** Drawn above it, on its own: what follows the hand. */
  readonly moving?: Layer;
  /** The wheel and two fingers on a touchpad zoom, + - and 0 too; a drag with the middle button pans. */
  readonly zoom?: boolean;
  readonly height_px?: number;
  /** Leave the axes' labels out, for small plots whose neighbours carry them. */
  readonly small?: boolean;
  /** Names at the ends of curves, in a margin of their own on the right. */
  readonly ends?: () => readonly EndLabel[];
}
