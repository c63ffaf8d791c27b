/** Light, dark, or as the system has it; remembered in this browser. */

import { refreshPalette } from "../draw/palette";
import { signal } from "../ui/signal.svelte";

export type Theme = "system" | "light" | "dark";
const KEY = "fdvv-theme";
const order: readonly Theme[] = ["system", "light", "dark"];

export const theme = signal<Theme>(remembered());

function remembered(): Theme {
  const found = localStorage.getItem(KEY);
  return order.find((one) => one === found) ?? "system";
}

export function nextTheme(): void {
  theme.update((now) => order[(order.indexOf(now) + 1) % order.length] as Theme);
  localStorage.setItem(KEY, theme.peek());
  apply();
}

export function apply(): void {
  const chosen = theme.peek();
  const dark =
    chosen === "dark" || (chosen === "system" && matchMedia("(prefers-color-scheme: dark)").matches);
  document.documentElement.dataset.theme = dark ? "dark" : "light";
  refreshPalette();
}

export function followTheme(): void {
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", apply);
  apply();
}
