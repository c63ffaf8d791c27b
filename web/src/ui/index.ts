/** The toolbox of every page. */

export * from "./busy.svelte";
export * from "./element";
export * from "./force";
export * from "./keys";
export * from "./later";
export * from "./numbers";
export * from "./pointer";
export * from "./signal.svelte";
export * from "./toast";
