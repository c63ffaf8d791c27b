/** One way to draw, on a canvas or into an SVG file: what is seen is what is exported. */

import type { ScreenPoint } from "./scale";

export interface Stroke {
  readonly colour: string;
  readonly width_px?: number;
  readonly dash?: readonly number[];
  readonly opacity?: number;
}

export interface Fill {
  readonly colour: string;
  readonly opacity?: number;
}

export interface TextStyle {
  readonly colour: string;
  readonly size_px?: number;
  readonly weight?: number;
  readonly align?: "left" | "center" | "right";
  readonly base?: "top" | "middle" | "bottom";
  /** Turned to read upwards. */
  readonly upwards?: boolean;
  /** Painted behind the letters, so that they read on top of curves. */
  readonly halo?: string;
}

export interface Box {
  readonly left: number;
  readonly top: number;
  readonly width: number;
  readonly height: number;
}

/** Coordinates are pixels; x_px and y_px are columns of one length. Points that are not finite break a line. */
export interface Brush {
  line(x_px: ArrayLike<number>, y_px: ArrayLike<number>, stroke: Stroke): void;
  area(x_px: ArrayLike<number>, y_px: ArrayLike<number>, fill: Fill): void;
  rect(box: Box, fill: Fill | null, stroke?: Stroke): void;
  circle(at: ScreenPoint, radius_px: number, fill: Fill | null, stroke?: Stroke): void;
  text(text: string, at: ScreenPoint, style: TextStyle): void;
  /** Draw only inside a box while work runs. */
  clipped(box: Box, work: () => void): void;
}

const FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, sans-serif";

/** Wide enough that what lies behind a letter does not read as one. */
const HALO_px = 5;

export class CanvasBrush implements Brush {
  constructor(private readonly context: CanvasRenderingContext2D) {}

  line(x_px: ArrayLike<number>, y_px: ArrayLike<number>, stroke: Stroke): void {
    this.path(x_px, y_px);
    this.stroke(stroke);
  }

  area(x_px: ArrayLike<number>, y_px: ArrayLike<number>, fill: Fill): void {
    this.path(x_px, y_px);
    this.context.closePath();
    this.fill(fill);
  }

  rect(box: Box, fill: Fill | null, stroke?: Stroke): void {
    this.context.beginPath();
    this.context.rect(box.left, box.top, box.width, box.height);
    if (fill) this.fill(fill);
    if (stroke) this.stroke(stroke);
  }

  circle(at: ScreenPoint, radius_px: number, fill: Fill | null, stroke?: Stroke): void {
    this.context.beginPath();
    this.context.arc(at.x_px, at.y_px, radius_px, 0, 2 * Math.PI);
    if (fill) this.fill(fill);
    if (stroke) this.stroke(stroke);
  }

  text(text: string, at: ScreenPoint, style: TextStyle): void {
    const c = this.context;
    c.save();
    c.font = `${style.weight ?? 400} ${style.size_px ?? 12}px ${FONT}`;
    c.textAlign = style.align ?? "left";
    c.textBaseline = style.base ?? "middle";
    c.translate(at.x_px, at.y_px);
    if (style.upwards) c.rotate(-Math.PI / 2);
    if (style.halo) {
      c.strokeStyle = style.halo;
      c.lineWidth = HALO_px;
      c.lineJoin = "round";
      c.strokeText(text, 0, 0);
    }
    c.fillStyle = style.colour;
    c.fillText(text, 0, 0);
    c.restore();
  }

  clipped(box: Box, work: () => void): void {
    this.context.save();
    this.context.beginPath();
    this.context.rect(box.left, box.top, box.width, box.height);
    this.context.clip();
    work();
    this.context.restore();
  }

  private path(x_px: ArrayLike<number>, y_px: ArrayLike<number>): void {
    const c = this.context;
    c.beginPath();
    let down = false;
    for (let i = 0; i < x_px.length; i++) {
      const [x, y] = [x_px[i] as number, y_px[i] as number];
      if (!Number.isFinite(x + y)) down = false;
      else if (down) c.lineTo(x, y);
      else {
        c.moveTo(x, y);
        down = true;
      }
    }
  }

  private stroke(stroke: Stroke): void {
    const c = this.context;
    c.globalAlpha = stroke.opacity ?? 1;
    c.strokeStyle = stroke.colour;
    c.lineWidth = stroke.width_px ?? 1;
    c.lineJoin = "round";
    c.setLineDash((stroke.dash ?? []) as number[]);
    c.stroke();
    c.globalAlpha = 1;
  }

  private fill(fill: Fill): void {
    this.context.globalAlpha = fill.opacity ?? 1;
    this.context.fillStyle = fill.colour;
    this.context.fill();
    this.context.globalAlpha = 1;
  }
}

function rounded(value: number): string {
  return Number(value.toFixed(2)).toString();
}

function escaped(text: string): string {
  return text.replace(/[&<>"']/g, (c) => `&#${c.charCodeAt(0)};`);
}

/** Writes what is drawn as SVG text. */
export class SvgBrush implements Brush {
  private readonly parts: string[] = [];
  private clips = 0;

  line(x_px: ArrayLike<number>, y_px: ArrayLike<number>, stroke: Stroke): void {
    this.parts.push(`<path d="${this.path(x_px, y_px)}" fill="none"${this.stroked(stroke)}/>`);
  }

  area(x_px: ArrayLike<number>, y_px: ArrayLike<number>, fill: Fill): void {
    this.parts.push(`<path d="${this.path(x_px, y_px)}Z"${this.filled(fill)}/>`);
  }

  rect(box: Box, fill: Fill | null, stroke?: Stroke): void {
    const place = `x="${rounded(box.left)}" y="${rounded(box.top)}" width="${rounded(box.width)}" height="${rounded(box.height)}"`;
    this.parts.push(`<rect ${place}${this.filled(fill)}${this.stroked(stroke)}/>`);
  }

  circle(at: ScreenPoint, radius_px: number, fill: Fill | null, stroke?: Stroke): void {
    const place = `cx="${rounded(at.x_px)}" cy="${rounded(at.y_px)}" r="${rounded(radius_px)}"`;
    this.parts.push(`<circle ${place}${this.filled(fill)}${this.stroked(stroke)}/>`);
  }

  text(text: string, at: ScreenPoint, style: TextStyle): void {
    const place = `x="${rounded(at.x_px)}" y="${rounded(at.y_px)}"`;
    const turn = style.upwards ? ` transform="rotate(-90 ${rounded(at.x_px)} ${rounded(at.y_px)})"` : "";
    const anchor = { left: "start", center: "middle", right: "end" }[style.align ?? "left"];
    const base = { top: "text-before-edge", middle: "central", bottom: "text-after-edge" }[
      style.base ?? "middle"
    ];
    const halo = style.halo ? ` stroke="${style.halo}" stroke-width="${HALO_px}" paint-order="stroke"` : "";
    const font = `font-family="${FONT}" font-size="${style.size_px ?? 12}" font-weight="${style.weight ?? 400}"`;
    this.parts.push(
      `<text ${place}${turn} fill="${style.colour}" text-anchor="${anchor}" dominant-baseline="${base}"${halo} ${font}>${escaped(text)}</text>`,
    );
  }

  clipped(box: Box, work: () => void): void {
    const id = `clip${++this.clips}`;
    const place = `x="${rounded(box.left)}" y="${rounded(box.top)}" width="${rounded(box.width)}" height="${rounded(box.height)}"`;
    this.parts.push(`<clipPath id="${id}"><rect ${place}/></clipPath><g clip-path="url(#${id})">`);
    work();
    this.parts.push("</g>");
  }

  /** Return the whole file. */
  file(width_px: number, height_px: number, background: string): string {
    const size = `width="${width_px}" height="${height_px}" viewBox="0 0 ${width_px} ${height_px}"`;
    const back = `<rect width="100%" height="100%" fill="${background}"/>`;
    return `<svg xmlns="http://www.w3.org/2000/svg" ${size}>${back}${this.parts.join("")}</svg>\n`;
  }

  private path(x_px: ArrayLike<number>, y_px: ArrayLike<number>): string {
    let [text, down] = ["", false];
    for (let i = 0; i < x_px.length; i++) {
      const [x, y] = [x_px[i] as number, y_px[i] as number];
      if (!Number.isFinite(x + y)) {
        down = false;
        continue;
      }
      text += `${down ? "L" : "M"}${rounded(x)} ${rounded(y)}`;
      down = true;
    }
    return text;
  }

  private stroked(stroke: Stroke | undefined): string {
    if (!stroke) return "";
    const dash = stroke.dash?.length ? ` stroke-dasharray="${stroke.dash.join(" ")}"` : "";
    const seen = stroke.opacity === undefined ? "" : ` stroke-opacity="${stroke.opacity}"`;
    return ` stroke="${stroke.colour}" stroke-width="${stroke.width_px ?? 1}" stroke-linejoin="round"${dash}${seen}`;
  }

  private filled(fill: Fill | null): string {
    if (!fill) return ' fill="none"';
    return ` fill="${fill.colour}"${fill.opacity === undefined ? "" : ` fill-opacity="${fill.opacity}"`}`;
  }
}
