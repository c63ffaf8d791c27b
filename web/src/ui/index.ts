/** The toolbox of every page. */

export * from "./controls";
export * from "./element";
export * from "./force";
export * from "./keys";
export * from "./later";
export * from "./pointer";
export * from "./signal.svelte";
export * from "./toast";
