/** The studio's server. */

export * from "./call";
export * from "./clock";
export * from "./live";
export type * from "./messages";
export * from "./settings";
