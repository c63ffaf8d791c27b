/** Asking while a hand moves: one question under way at a time, and only the newest of those that wait. */

/** Asks with the newest question: at once when nothing is under way, else as soon as the answer is there. */
export class Latest<Ask, Answer> {
  private waiting: { readonly ask: Ask } | null = null;
  private busy = false;
  private closed = false;

  /**
   * @param work - asks. @param onAnswer - gets every answer until it is closed.
   * @param wrong - gets what was thrown.
   */
  constructor(
    private readonly work: (ask: Ask) => Promise<Answer>,
    private readonly onAnswer: (answer: Answer, ask: Ask) => void,
    private readonly wrong: (error: unknown) => void,
  ) {}

  /** Ask; a question that still waits is forgotten. */
  ask(question: Ask): void {
    this.waiting = { ask: question };
    if (!this.busy) void this.run();
  }

  /** Answer nothing any more. */
  close(): void {
    this.closed = true;
    this.waiting = null;
  }

  private async run(): Promise<void> {
    this.busy = true;
    while (this.waiting) {
      const { ask } = this.waiting;
      this.waiting = null;
      try {
        const answer = await this.work(ask);
        if (!this.closed) this.onAnswer(answer, ask);
      } catch (error) {
        if (!this.closed) this.wrong(error);
      }
    }
    this.busy = false;
  }
}
