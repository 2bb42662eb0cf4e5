/** What a key asks for. */

export type Action =
  | { readonly kind: "play" | "begin" | "end" | "edit" | "remove" | "leave" | "undo" | "save" }
  | { readonly kind: "frame" | "second" | "mark" | "edge" | "zoom"; readonly direction: -1 | 1 }
  | { readonly kind: "gesture"; readonly index: number };

type Key = Pick<KeyboardEvent, "key" | "shiftKey" | "ctrlKey" | "metaKey" | "altKey">;

const PLAIN: ReadonlyMap<string, Action> = new Map<string, Action>([
  [" ", { kind: "play" }],
  ["i", { kind: "begin" }],
  ["o", { kind: "end" }],
  ["enter", { kind: "edit" }],
  ["delete", { kind: "remove" }],
  ["backspace", { kind: "remove" }],
  ["escape", { kind: "leave" }],
  ["arrowleft", { kind: "frame", direction: -1 }],
  ["arrowright", { kind: "frame", direction: 1 }],
  ["arrowup", { kind: "mark", direction: -1 }],
  ["arrowdown", { kind: "mark", direction: 1 }],
  ["home", { kind: "edge", direction: -1 }],
  ["end", { kind: "edge", direction: 1 }],
  ["-", { kind: "zoom", direction: -1 }],
  ["+", { kind: "zoom", direction: 1 }],
  ["=", { kind: "zoom", direction: 1 }],
]);

/**
 * @param isTyping Whether the key belongs to a field that is being filled in.
 * @returns What is asked for, or null where the key is the browser's or the field's.
 */
export function actionOf(event: Key, isTyping: boolean): Action | null {
  const key = event.key.toLowerCase();
  if (event.altKey) return null;
  if (event.ctrlKey || event.metaKey) {
    if (key === "s") return { kind: "save" };
    return key === "z" && !isTyping ? { kind: "undo" } : null;
  }
  if (isTyping) return key === "escape" ? { kind: "leave" } : null;
  const action = PLAIN.get(key);
  if (action?.kind === "frame" && event.shiftKey) return { ...action, kind: "second" };
  if (action !== undefined) return action;
  return /^[1-9]$/.test(key) ? { kind: "gesture", index: Number(key) - 1 } : null;
}
