/** Drawing: axes, curves, export. */

export * from "./brush";
export * from "./file";
export * from "./labels";
export * from "./palette";
export * from "./plot";
export * from "./scale";
export * from "./types";
export * from "./velocity";
