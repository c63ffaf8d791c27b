/** Names of keys, as the browser calls them (KeyboardEvent.code), by their usage of HID's keyboard page. */

/** HID Usage Tables, section 10, from 0x28 on; digits, letters and function keys are in order. */
const MORE: readonly (readonly [from: number, names: string])[] = [
  [0x28, "Enter Escape Backspace Tab Space Minus Equal BracketLeft BracketRight Backslash"],
  [0x33, "Semicolon Quote Backquote Comma Period Slash CapsLock F1 F2 F3 F4 F5 F6 F7 F8 F9 F10 F11 F12"],
  [0x49, "Insert Home PageUp Delete End PageDown ArrowRight ArrowLeft ArrowDown ArrowUp"],
  [0x64, "IntlBackslash ContextMenu"],
  [0xe0, "ControlLeft ShiftLeft AltLeft MetaLeft ControlRight ShiftRight AltRight MetaRight"],
];

/** Return the browser's name of a usage; empty if it has none here. */
export function keyCode(usage: number): string {
  if (usage >= 0x04 && usage <= 0x1d) return `Key${String.fromCharCode(0x41 + usage - 0x04)}`;
  if (usage >= 0x1e && usage <= 0x27) return `Digit${(usage - 0x1e + 1) % 10}`;
  for (const [from, names] of MORE) {
    const found = names.split(" ")[usage - from];
    if (usage >= from && found) return found;
  }
  return "";
}

/** Name a key for people. */
export function keyName(code: string, usage: number): string {
  return code ? printed(code) : `key ${usage}`;
}

/** Write a browser's name of a key as it is printed on it. */
export function printed(code: string): string {
  return code.replace(/^(Key|Digit)/, "").replace(/([a-z])([A-Z])/g, "$1 $2");
}
