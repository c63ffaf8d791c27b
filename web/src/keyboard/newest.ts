/** Return a function that passes on the newest of what it is given, at most once in so many ms, the last one always. */
export function newest<T>(every_ms: number, pass: (value: T) => void): (value: T) => void {
  let [waits, due] = [false, false];
  let last: T;
  const later = () => {
    waits = due;
    if (!due) return;
    due = false;
    pass(last);
    setTimeout(later, every_ms);
  };
  return (value) => {
    last = value;
    if (waits) {
      due = true;
      return;
    }
    waits = true;
    pass(value);
    setTimeout(later, every_ms);
  };
}
