// The client of `fdvv serve` for browsers and Node 22 (Node 20: node --experimental-websocket). One file, no
// dependencies. Calls and events are those of docs/reference/serve-messages.md.

/** What the server refuses: of what, where in it, why, and what to do. */
export class FdvvError extends Error {
  /** @param {{source: string, place: string, reason: string, remedy: string}} error */
  constructor(error) {
    super([error.source, error.place, error.reason].filter(Boolean).join(": ") + (error.remedy ? `; ${error.remedy}` : ""));
    this.name = "FdvvError";
    Object.assign(this, error);
  }
}

/** The connection was lost before the answer came; whether the call was done is not known. */
export class FdvvLost extends Error {
  constructor() {
    super("the connection to fdvv serve was lost");
    this.name = "FdvvLost";
  }
}

const AGAIN_ms = 500;
const REPEATABLE = new Set(["clock", "optimize.resume", "optimize.ask", "optimize.tell", "optimize.best",
  "optimize.compare", "optimize.prefer"]);

/**
 * A connection that comes back by itself. Calls about a run survive that: the server keeps every score, and the
 * same report twice counts once. Calls of a device fail with FdvvLost: its force was set to zero; open it again.
 */
export class Fdvv {
  /**
   * @param {string} address as `fdvv serve` prints it, such as ws://127.0.0.1:8378/fdvv
   * @param {string} token as it prints it
   * @param {{onEvent?: (event: any) => void, onConnection?: (connected: boolean) => void}} [listeners]
   *   onEvent: every event; onConnection: true once connected, false when the connection is lost
   */
  constructor(address, token, listeners = {}) {
    this.address = address;
    this.token = token;
    this.listeners = listeners;
    /** What the server offers, once connected. @type {any} */
    this.welcome = null;
    this._next = 1;
    /** @type {Map<number, {text: string, repeat: boolean, sent: boolean, done: (v: any) => void, failed: (e: Error) => void}>} */
    this._waiting = new Map();
    /** @type {WebSocket | null} */
    this._socket = null;
    this._closed = false;
  }

  /** Connect; resolves with what the server offers, rejects where it refuses the token. @returns {Promise<any>} */
  connect() {
    return new Promise((done, failed) => this._open(done, failed));
  }

  /** End the connection for good; a device that was open falls to zero force. */
  close() {
    this._closed = true;
    this._socket?.close();
    this._fail(() => true, new FdvvLost());
  }

  /**
   * Do a call and return its result. Rejects with FdvvError or FdvvLost.
   * @param {string} call such as "optimize.ask" @param {object} [fields] @returns {Promise<any>}
   */
  call(call, fields = {}) {
    const id = this._next++;
    const text = JSON.stringify({ id, call, ...fields });
    return new Promise((done, failed) => {
      if (this._closed || (!this.welcome && !REPEATABLE.has(call))) return failed(new FdvvLost());
      this._waiting.set(id, { text, repeat: REPEATABLE.has(call), sent: false, done, failed });
      if (this.welcome) this._send();
    });
  }

  /** Begin a run, or continue it where there is one of this name. @param {string} run @param {object} fields */
  async run(run, fields) {
    const known = this.welcome?.runs.includes(run);
    if (!known) {
      await this.call("optimize.begin", { run, ...fields });
      this.welcome?.runs.push(run);
    }
    return this.call("optimize.resume", { run });
  }

  /** The design to try next; trial null at the end. @param {string} run
   * @returns {Promise<{trial: number | null, design: Record<string, number>, model: any, left: number, finished: boolean}>} */
  ask(run) {
    return this.call("optimize.ask", { run });
  }

  /** Report a score. @param {string} run @param {number} trial @param {number} score @param {number} [error] */
  tell(run, trial, score, error) {
    return this.call("optimize.tell", { run, trial, score, ...(error === undefined ? {} : { error }) });
  }

  /** Report that a trial could not be scored. @param {string} run @param {number} trial @param {string} reason */
  fail(run, trial, reason) {
    return this.call("optimize.tell", { run, trial, outcome: "failed", reason });
  }

  /** Report that a trial was stopped; it does not count. @param {string} run @param {number} trial @param {string} [reason] */
  abandon(run, trial, reason = "") {
    return this.call("optimize.tell", { run, trial, outcome: "abandoned", reason });
  }

  /** The recommended design with its 95 % interval. @param {string} run
   * @returns {Promise<{design: Record<string, number>, mean: number, low: number, high: number, count: number}>} */
  best(run) {
    return this.call("optimize.best", { run });
  }

  /** @param {(welcome: any) => void} [done] @param {(error: Error) => void} [failed] */
  _open(done = () => {}, failed = () => {}) {
    const socket = new WebSocket(this.address);
    this._socket = socket;
    let refused = false;
    socket.onopen = () => socket.send(JSON.stringify({ id: 0, call: "hello", token: this.token }));
    socket.onmessage = ({ data }) => {
      const message = JSON.parse(data);
      if (message.event) return this.listeners.onEvent?.(message);
      if (message.id !== 0) return this._answered(message);
      if (message.error) {
        refused = true;
        return failed(new FdvvError(message.error));
      }
      this.welcome = message.result;
      this.listeners.onConnection?.(true);
      this._send();
      done(message.result);
    };
    let over = false;
    // a socket that never opened tells it by an error alone in some versions of Node
    socket.onclose = socket.onerror = () => {
      if (over) return;
      over = true;
      const connected = this.welcome !== null;
      this.welcome = null;
      if (connected) this.listeners.onConnection?.(false);
      for (const one of this._waiting.values()) one.sent = one.sent && !one.repeat;
      this._fail((one) => one.sent, new FdvvLost());
      if (!this._closed && !refused) setTimeout(() => this._closed || this._open(done, failed), AGAIN_ms);
    };
  }

  _send() {
    for (const one of this._waiting.values()) {
      if (!one.sent) this._socket?.send(one.text);
      one.sent = true;
    }
  }

  /** @param {any} message */
  _answered(message) {
    const one = this._waiting.get(message.id);
    this._waiting.delete(message.id);
    if (message.error) one?.failed(new FdvvError(message.error));
    else one?.done(message.result);
  }

  /** @param {(one: any) => boolean} chosen @param {Error} error */
  _fail(chosen, error) {
    for (const [id, one] of this._waiting) {
      if (!chosen(one)) continue;
      this._waiting.delete(id);
      one.failed(error);
    }
  }
}
