/** One program: its graph beside the forces of the chosen state, its numbers, its check, a finger to try it. */

import { go, keepQuery } from "../../app/route";
import { download } from "../../draw";
import { call } from "../../net";
import type { ProgramText } from "../../net/messages";
import type { Point } from "../../programs/geometry";
import { type Choice, choiceAt, pathOf } from "../../programs/path";
import {
  addShortcuts,
  button,
  effect,
  h,
  onCleanup,
  panel,
  signal,
  tabs,
  tell,
  toast,
  toolbar,
  untracked,
} from "../../ui";
import { ProgramBook, type SaveState } from "./book";
import { findingsPanel } from "./findings";
import { ForcePanel } from "./forces";
import { GraphPanel } from "./graph";
import { inspector } from "./inspector";
import { savedPositions, savePositions } from "./positions";
import { refreshRows, SERVER } from "./server";
import { tryPanel } from "./try";

/** Mount an opened program; `at` is the path of the part to show first. */
export function editor(host: HTMLElement, opened: ProgramText, at: string): void {
  const book = new ProgramBook(SERVER, opened);
  refreshRows();
  const live = signal<string | null>(null);
  const moved = savedPositions(book.id);
  const graph = new GraphPanel({ book, moved, live });
  const state = signal(book.document.peek().start);
  const forces = new ForcePanel(book, state);
  book.choose(at ? choiceAt(book.document.peek(), at) : { kind: "state", state: book.document.peek().start });
  followChoice(book, (name) => state.set(name));
  effect(() => savePositions(book.id, moved()));
  keys(book, graph);
  guardTab(book);
  host.append(
    titleRow(book),
    h(
      "div",
      { class: "program" },
      graphPanel(book, graph, moved),
      beside(book, forces, live.set),
      inspector(book, graph),
      findingsPanel(book, (choice) => lead(book, graph, choice)),
    ),
  );
}

/** Beside the graph: the forces of the state, or a finger on the program, which runs only while it is seen. */
function beside(book: ProgramBook, forces: ForcePanel, live: (state: string | null) => void): HTMLElement {
  const shown = signal<"forces" | "try">("forces");
  const place = h("div", { class: "beside-place" });
  effect(() => {
    place.replaceChildren(shown() === "forces" ? forces.element : untracked(() => tryPanel(book, live)));
  });
  const choice = tabs({
    label: "Beside the graph",
    tabs: [
      ["forces", "Forces"],
      ["try", "Press it"],
    ],
    value: shown,
    set: shown.set,
  });
  return h("div", { class: "beside" }, choice, place);
}

/** The forces shown are those of the state that is chosen, or begins the chosen transition. */
function followChoice(book: ProgramBook, show: (state: string) => void): void {
  effect(() => {
    const [choice, document] = [book.choice(), book.document()];
    if (choice.kind === "state" || choice.kind === "transition") show(choice.state);
    else if (choice.kind === "surface") {
      const feels = document.states.find(
        (held) => held.press === choice.surface || held.release === choice.surface,
      );
      if (feels) show(feels.name);
    }
    const path = pathOf(document, choice);
    keepQuery(path ? { at: path } : {});
  });
}

function lead(book: ProgramBook, graph: GraphPanel, choice: Choice): void {
  book.choose(choice);
  graph.focusChosen();
}

const SAID: Readonly<Record<SaveState["kind"], string>> = {
  saved: "saved",
  waiting: "not saved yet",
  saving: "saving…",
  scratch: "shipped: your changes stay on this page until you save a copy",
  refused: "not saved: ",
};

function titleRow(book: ProgramBook): HTMLElement {
  const undo = button({
    label: "Undo",
    glyph: "↶",
    disabled: () => book.undoLabel() === null,
    act: () => book.undo(),
  });
  const redo = button({
    label: "Redo",
    glyph: "↷",
    disabled: () => book.redoLabel() === null,
    act: () => book.redo(),
  });
  return h(
    "div",
    { class: "row spread title-row" },
    h(
      "div",
      { class: "row" },
      button({ label: "All programs", kind: "quiet", act: () => go("programs") }),
      h("h1", {}, () => book.document().name),
      h(
        "span",
        { class: () => `save-state ${book.saved().kind}`, role: "status" },
        () => SAID[book.saved().kind] + book.saved().line,
      ),
      h("span", {}, () =>
        book.saved().kind === "refused" ? button({ label: "Save again", act: () => void book.save() }) : null,
      ),
    ),
    toolbar("Program", undo, redo, keepIt(book), exportIt(book), linkIt()),
  );
}

/** A shipped program is kept as one's own; so is what another tab has overtaken. */
function keepIt(book: ProgramBook): HTMLElement {
  const keep = async (): Promise<void> => {
    const kept = await call("program.keep", { text: book.text });
    go("programs", kept.program);
  };
  return button({
    label: book.own ? "Save as" : "Save as my own",
    kind: book.own ? "plain" : "main",
    act: () => void keep().catch(tell),
  });
}

function exportIt(book: ProgramBook): HTMLElement {
  const act = async (): Promise<void> => {
    // what is on the server is the canonical text; a shipped one may have changed on this page
    await book.save();
    const text = book.own ? (await call("program.open", { program: book.id })).text : `${book.text}\n`;
    download(
      `${book.document.peek().name.replace(/[^\w .-]/g, "-")}.fdvv-program.json`,
      text,
      "application/json",
    );
  };
  return button({ label: "Export file", act: () => void act().catch(tell) });
}

function linkIt(): HTMLElement {
  const act = (): void =>
    void navigator.clipboard.writeText(location.href).then(() => toast("Link copied.", "done"), tell);
  return button({ label: "Copy link", hint: "To this program with the current selection", act });
}

function graphPanel(
  book: ProgramBook,
  graph: GraphPanel,
  moved: ReturnType<typeof savedPositions>,
): HTMLElement {
  const tools = toolbar(
    "Graph",
    button({ label: "Add state", hint: "N, or a double click", act: () => void graph.addState() }),
    button({
      label: "Add transition",
      hint: "T on a state, or drag the dot at its edge",
      disabled: () => book.choice().kind !== "state",
      act: () => graph.begin(),
    }),
    button({
      label: "Program",
      hint: "Name, travel, signals and vibrations",
      kind: "quiet",
      act: () => book.choose({ kind: "program" }),
    }),
    button({ label: "Zoom in", glyph: "+", kind: "quiet", act: () => graph.view.zoomBy(1.25) }),
    button({ label: "Zoom out", glyph: "−", kind: "quiet", act: () => graph.view.zoomBy(0.8) }),
    button({ label: "Fit", kind: "quiet", act: () => graph.view.fit() }),
    button({
      label: "Tidy",
      hint: "Reset every state to its automatic position",
      kind: "quiet",
      disabled: () => moved().size === 0,
      act: () => tidy(graph, moved),
    }),
  );
  const found = panel("States", tools, graph.element);
  found.classList.add("states");
  return found;
}

function tidy(graph: GraphPanel, moved: { set(places: ReadonlyMap<string, Point>): void }): void {
  moved.set(new Map());
  graph.view.fit();
}

function keys(book: ProgramBook, graph: GraphPanel): void {
  addShortcuts(
    { keys: "Ctrl+Z", does: "Undo", act: () => book.undo() },
    { keys: "Ctrl+Shift+Z", does: "Redo", act: () => book.redo() },
    { keys: "Ctrl+Y", does: "Redo", act: () => book.redo() },
    { keys: "Ctrl+S", does: "Save now", act: () => void book.save(), always: true },
    { keys: "N", does: "Add a state", act: () => void graph.addState() },
    {
      keys: "T",
      does: "Begin a transition at the chosen state; Enter on another ends it",
      act: () => graph.begin(),
    },
    {
      keys: "G",
      does: "Focus the selection in the graph; arrows walk, Shift+arrows move it",
      act: () => graph.focusChosen(),
    },
    { keys: "Delete", does: "Remove the selection", act: () => graph.remove() },
    { keys: "Escape", does: "Cancel a new transition", act: () => graph.drawing.set(null) },
  );
}

/** What is unsaved is written when the page is left; a tab that is closed asks first. */
function guardTab(book: ProgramBook): void {
  const ask = (event: BeforeUnloadEvent): void => {
    if (book.saved.peek().kind !== "saved" && book.own) event.preventDefault();
  };
  addEventListener("beforeunload", ask);
  onCleanup(() => {
    removeEventListener("beforeunload", ask);
    void book.close().then(() => book.saved.peek().kind === "refused" && offerToKeep(book));
  });
}

/** What could not be written must not be lost by going elsewhere. */
function offerToKeep(book: ProgramBook): void {
  const { name } = book.document.peek();
  toast(`“${name}” was not saved: ${book.saved.peek().line}`, "wrong", [
    "Save as",
    () => void call("program.keep", { text: book.text }).then((kept) => go("programs", kept.program), tell),
  ]);
}
