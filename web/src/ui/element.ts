/** Elements from code: never from text, so that no button name can become markup. */

import { effect } from "./signal.svelte";

export type Child = Node | string | number | null | false | undefined | readonly Child[] | (() => Child);
type Value = string | number | boolean | null | undefined;

export type Props = {
  readonly class?: string | (() => string);
  readonly style?: Readonly<Record<string, string | (() => string)>>;
  /** Listeners by event name. */
  readonly on?: { readonly [K in keyof HTMLElementEventMap]?: (event: HTMLElementEventMap[K]) => void };
  /** Given the element once it is made. */
  readonly ref?: (element: HTMLElement) => void;
  readonly [attribute: string]: unknown;
};

/** Set an attribute, or the live property where the attribute is only its beginning. */
function assign(element: Element, name: string, value: Value): void {
  if (name === "value" || name === "checked" || name === "indeterminate") {
    (element as unknown as Record<string, Value>)[name] = value ?? "";
  } else if (value === false || value === null || value === undefined) {
    element.removeAttribute(name);
  } else {
    element.setAttribute(name, value === true ? "" : String(value));
  }
}

function fill(element: Element, props: Props): void {
  for (const [name, value] of Object.entries(props)) {
    if (name === "on") {
      for (const [event, listener] of Object.entries(value as object)) {
        element.addEventListener(event, listener as EventListener);
      }
    } else if (name === "style") {
      styles(element as HTMLElement, value as NonNullable<Props["style"]>);
    } else if (name !== "ref") {
      if (typeof value === "function") effect(() => assign(element, name, (value as () => Value)()));
      else assign(element, name, value as Value);
    }
  }
}

function styles(element: HTMLElement, values: NonNullable<Props["style"]>): void {
  for (const [name, value] of Object.entries(values)) {
    if (typeof value === "function") effect(() => element.style.setProperty(name, value()));
    else element.style.setProperty(name, value);
  }
}

function nodes(child: Child): Node[] {
  if (child === null || child === undefined || child === false) return [];
  if (typeof child === "string" || typeof child === "number") return [document.createTextNode(String(child))];
  if (child instanceof Node) return [child];
  if (typeof child === "function") return [following(child)];
  return child.flatMap(nodes);
}

/** A place whose content follows signals. */
function following(content: () => Child): Node {
  const place = document.createElement("fdvv-slot");
  effect(() => place.replaceChildren(...nodes(content())));
  return place;
}

/** Make an HTML element; props and children may be functions, which then follow the signals they read. */
export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  props: Props = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  element.append(...nodes(children));
  fill(element, props);
  props.ref?.(element);
  return element;
}
