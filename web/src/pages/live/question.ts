/** The view of a tuning: play what was pressed, say which is closer, blind; what the answers come to so far. */

import type { PlayedWave, QuestionAsked, TuneRanking } from "../../net";
import { addShortcuts, button, type Child, computed, h, panel, signal, tell, untracked } from "../../ui";
import { answerJob, watched } from "./jobs";
import { pressCue } from "./presscue";
import { peakOf, play } from "./sound";

const NAMES = ["A", "B"] as const;
/** What is being played: "A", "B" or "measured"; empty if nothing is. */
const playing = signal("");
/** The question that an answer is on its way to. */
let sent = 0;

export function tuneView(): Child {
  const asked = computed(() => watched().picture.question);
  return [
    pressCue(),
    () => {
      const question = asked();
      return question ? untracked(() => questionPanel(question)) : null;
    },
    ranking(),
  ];
}

function questionPanel(question: QuestionAsked): Child {
  sent = 0;
  const pair = question.waves.length === 2;
  addKeys(question, pair);
  const said = pair
    ? "Which is closer to the real button? Both were pressed; they are unnamed to keep you unbiased."
    : "How close is it to the real button? 1 is not at all, 7 is the same.";
  void playBoth(question);
  return panel(
    `Question ${question.number} of ${question.total} at most, at ${question.velocity_mm_s} mm/s`,
    h("p", { class: "wanted" }, said),
    players(question),
    pair ? pairAnswers(question) : ratings(question),
    h(
      "p",
      { class: "muted" },
      pair
        ? "Keys: 1 first, 2 second, 0 neither; Space plays again; R presses again."
        : "Keys: 1 to 7; Space plays again; R presses again.",
    ),
  );
}

function addKeys(question: QuestionAsked, pair: boolean): void {
  const give = (answer: string) => () => void answer_(question, answer);
  const keys = pair
    ? [
        ["1", "The first is closer", "first"],
        ["2", "The second is closer", "second"],
        ["0", "Neither is closer", "neither"],
      ]
    : Array.from({ length: 7 }, (_, i) => [`${i + 1}`, `Rate ${i + 1}`, `${i + 1}`]);
  addShortcuts(
    ...keys.map(([key, does, answer]) => ({
      keys: key as string,
      does: does as string,
      act: give(answer as string),
    })),
    { keys: "Space", does: "Play again", act: () => void playBoth(question) },
    { keys: "R", does: "Press again", act: give("again") },
  );
}

async function answer_(question: QuestionAsked, answer: string): Promise<void> {
  if (sent === question.number && answer !== "again") return;
  sent = question.number;
  await answerJob(watched.peek().job, question.number, answer);
  sent = 0;
}

function players(question: QuestionAsked): HTMLElement {
  const peak = peakOf([...question.waves, question.measured]);
  const player = (name: string, wave: PlayedWave) =>
    button({
      label: `Play ${name}`,
      act: () => void playOne(name, wave, peak),
      pressed: () => playing() === name,
    });
  return h(
    "div",
    { class: "row players" },
    question.waves.map((wave, i) => player(question.waves.length === 1 ? "it" : (NAMES[i] as string), wave)),
    h("span", { class: "grow" }),
    player("the measured one", question.measured),
  );
}

async function playOne(name: string, wave: PlayedWave, peak: number): Promise<void> {
  playing.set(name);
  try {
    await play(wave, peak);
  } catch (error) {
    tell(error);
  } finally {
    playing.set("");
  }
}

const PAUSE_ms = 350;

/** Play what is asked about, one after the other. */
async function playBoth(question: QuestionAsked): Promise<void> {
  const peak = peakOf([...question.waves, question.measured]);
  for (const [i, wave] of question.waves.entries()) {
    await playOne(question.waves.length === 1 ? "it" : (NAMES[i] as string), wave, peak);
    await new Promise((resolve) => setTimeout(resolve, PAUSE_ms));
    if (watched.peek().picture.question !== question) return;
  }
}

function pairAnswers(question: QuestionAsked): HTMLElement {
  const one = (label: string, answer: string, kind: "main" | "plain") =>
    button({ label, kind, act: () => void answer_(question, answer) });
  return h(
    "div",
    { class: "row answers", role: "group", "aria-label": "Which is closer" },
    one("A is closer (1)", "first", "main"),
    one("B is closer (2)", "second", "main"),
    one("Neither (0)", "neither", "plain"),
    one("Press again (R)", "again", "plain"),
  );
}

function ratings(question: QuestionAsked): HTMLElement {
  const one = (rating: number) =>
    button({ label: `${rating}`, act: () => void answer_(question, `${rating}`) });
  const again = button({
    label: "Press again (R)",
    kind: "plain",
    act: () => void answer_(question, "again"),
  });
  return h(
    "div",
    { class: "row answers", role: "group", "aria-label": "How close" },
    Array.from({ length: 7 }, (_, i) => one(i + 1)),
    again,
  );
}

/** What the answers come to; closed while they are given, for looking may lead them. */
function ranking(): Child {
  const over = computed(() => watched().picture.outcomes.length > 0);
  const rankings = computed(() => watched().picture.rankings);
  return () =>
    rankings().length
      ? h(
          "details",
          { class: "panel", open: over() },
          h("summary", {}, over() ? "Ranking" : "Ranking so far (seeing it may bias your answers)"),
          rankings().map(rankingTable),
        )
      : null;
}

function rankingTable(found: TuneRanking): HTMLElement {
  const heads = ["Hz", "m/s²", "score", "standard error"];
  const number = (value: number | null, digits: number) =>
    h("td", { class: "number" }, value === null ? "–" : value.toFixed(digits));
  const sorted = [...found.candidates].sort((a, b) => b.score - a.score);
  return h(
    "div",
    { class: "stack" },
    h("h3", {}, `${found.velocity_mm_s} mm/s, ${found.answers} answers: ${found.sentence}`),
    h(
      "table",
      { "aria-label": `Ranking at ${found.velocity_mm_s} mm/s` },
      h(
        "thead",
        {},
        h(
          "tr",
          {},
          h("th", { scope: "col" }, "vibration"),
          heads.map((text) => h("th", { scope: "col", class: "number" }, text)),
          h("th", { scope: "col" }, ""),
        ),
      ),
      h(
        "tbody",
        {},
        sorted.map((one) =>
          h(
            "tr",
            {},
            h("th", { scope: "row" }, one.name),
            number(one.frequency_Hz, 0),
            number(one.amplitude_m_s2, 1),
            number(one.score, 2),
            number(one.error, 2),
            h("td", {}, one.best ? "kept" : one.alike ? "tied with the best" : ""),
          ),
        ),
      ),
    ),
  );
}
