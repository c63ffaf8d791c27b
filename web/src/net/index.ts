/** The studio's server. */

export * from "./call";
export * from "./live";
export type * from "./messages";
