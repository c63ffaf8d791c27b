/** The toolbox of every page. */

export * from "./controls";
export * from "./element";
export * from "./keys";
export * from "./signal";
export * from "./toast";
