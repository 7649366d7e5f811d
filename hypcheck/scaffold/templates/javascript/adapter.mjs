// The door between hypcheck and predicate.mjs: questions on standard input, answers on standard output.
//
//     @BUILD@
//
// docs/protocol.md of hypcheck says what is spoken. Nothing here changes when the predicate does.
import * as asked from "./predicate.mjs"; // whole: one that takes no tilt needs no function tilted

const { description, predicate, tilted } = asked;

const TILT = description.tilt === true;
@position@
const COLUMNS = TILT ? 10 : 7;
const TILTED = TILT ? "tilted-" : "";
@passage@
const TIMES = description.times === true;
const COLUMNS = TILT ? 13 : 10;
@end@
const MOST = 65536;
const NOT_UNDERSTOOD = "the question is not understood";
@position@
const NO_ROW = TILT ? "a row is not ten decimals" : "a row is not seven decimals";
@passage@
const NO_ROW = TILT ? "a row is not thirteen decimals" : "a row is not ten decimals";
@end@
const DECIMAL = /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i; // Number alone would read "" as 0 and 0x10 as 16
const SPECIAL = { nan: NaN, inf: Infinity, "-inf": -Infinity };

class Trouble extends Error {}

const chunks = process.stdin[Symbol.asyncIterator]();
let held = Buffer.alloc(0); // read, and not yet used

/** The next line, null at the end of the input. */
async function readLine() {
  const parts = [];
  for (;;) {
    const end = held.indexOf("\n");
    if (end >= 0) {
      parts.push(held.subarray(0, end));
      held = held.subarray(end + 1);
      return Buffer.concat(parts).toString();
    }
    parts.push(held);
    const { value, done } = await chunks.next();
    held = done ? Buffer.alloc(0) : value;
    if (done) {
      const rest = Buffer.concat(parts);
      return rest.length ? rest.toString() : null;
    }
  }
}

async function readBytes(length) {
  const parts = [held];
  let size = held.length;
  while (size < length) {
    const { value, done } = await chunks.next();
    if (done) {
      held = Buffer.alloc(0);
      throw new Trouble("the input ended within the rows");
    }
    parts.push(value);
    size += value.length;
  }
  const all = Buffer.concat(parts);
  held = all.subarray(length);
  return all.subarray(0, length);
}

async function readText(n) {
  const lines = [];
  for (let i = 0; i < n; i++) lines.push(await readLine()); // all of them first, so that the next question is found
  const rows = new Float64Array(COLUMNS * n);
  lines.forEach((line, i) => rows.set(parseRow(line ?? ""), COLUMNS * i));
  return rows;
}

function parseRow(line) {
  const words = line.trim().split(/\s+/);
  if (words.length !== COLUMNS) throw new Trouble(NO_ROW);
  return words.map(parseNumber);
}

function parseNumber(word) {
  if (Object.hasOwn(SPECIAL, word)) return SPECIAL[word];
  if (!DECIMAL.test(word)) throw new Trouble(NO_ROW);
  return Number(word);
}

async function readBinary(n) {
  const bytes = await readBytes(8 * COLUMNS * n);
  const rows = new Float64Array(COLUMNS * n);
  for (let i = 0; i < rows.length; i++) rows[i] = bytes.readDoubleLE(8 * i);
  return rows;
}

@position@
function classify(rows, answers) {
  for (let i = 0, at = 0; i < answers.length; i++, at += COLUMNS) {
    answers[i] = TILT
      ? tilted(...rows.subarray(at, at + COLUMNS))
      : predicate(rows[at], rows[at + 1], rows[at + 2], rows[at + 3], rows[at + 4], rows[at + 5], rows[at + 6]);
  }
  return answers;
@passage@
/** Times of first contact, negative where there is none. */
function classify(rows, first) {
  for (let i = 0, at = 0; i < first.length; i++, at += COLUMNS) {
    first[i] = (TILT ? tilted : predicate)(...rows.subarray(at, at + COLUMNS));
  }
  return first;
@end@
}

@position@
function time(rows, answers, repeat) {
  const start = process.hrtime.bigint();
  for (let i = 0; i < repeat; i++) classify(rows, answers);
  const nanoseconds = process.hrtime.bigint() - start;
  return `${nanoseconds} ${answers.reduce((sum, answer) => sum + answer, 0)}`;
@passage@
const hit = (first) => (first >= 0 ? 1 : 0);

function inText(first) {
  return Array.from(first, (time) => (TIMES && hit(time) ? `1 ${time}\n` : `${hit(time)}\n`)).join("");
}

function inBinary(first) {
  const bytes = Buffer.alloc(first.length * (TIMES ? 9 : 1));
  first.forEach((time, i) => bytes.writeInt8(hit(time), i));
  if (TIMES) first.forEach((time, i) => bytes.writeDoubleLE(time, first.length + 8 * i));
  return bytes;
}

function time(rows, first, repeat) {
  const start = process.hrtime.bigint();
  for (let i = 0; i < repeat; i++) classify(rows, first);
  const nanoseconds = process.hrtime.bigint() - start;
  return `${nanoseconds} ${first.reduce((sum, time) => sum + hit(time), 0)}`;
@end@
}

/** A whole number in digits alone, from least to greatest. */
function count(word, least, greatest) {
  const number = /^\d{1,9}$/.test(word) ? Number(word) : NaN;
  if (number >= least && number <= greatest) return number;
  throw new Trouble(NOT_UNDERSTOOD);
}

/** Reads the rest of a question whose first line is given, and returns the reply in parts. */
async function answer(line) {
  const [verb, sequence, size, ...rest] = line.trim().split(/\s+/);
  if (!/^\d{1,19}$/.test(sequence)) throw new Trouble(NOT_UNDERSTOOD);
  const n = count(size, 0, MOST);
@position@
  const answers = new Int8Array(n);
  const form = `${verb} ${rest.at(-1)} ${rest.length}`;
  if (form === `classify ${TILTED}text 1`) {
    return [`${sequence} ${n}\n`, classify(await readText(n), answers).join("\n"), n ? "\n" : ""];
  }
  if (form === `classify ${TILTED}binary 1`) {
    return [`${sequence} ${n}\n`, classify(await readBinary(n), answers)];
  }
  if (form === `time ${TILTED}binary 2`) {
    const repeat = count(rest[0], 1, 999999999);
    return [`${sequence} ${time(await readBinary(n), answers, repeat)}\n`];
@passage@
  const first = new Float64Array(n);
  const form = `${verb} ${rest.at(-1)} ${rest.length}`;
  if (form === "classify passage-text 1") {
    return [`${sequence} ${n}\n`, inText(classify(await readText(n), first))];
  }
  if (form === "classify passage-binary 1") {
    return [`${sequence} ${n}\n`, inBinary(classify(await readBinary(n), first))];
  }
  if (form === "time passage-binary 2") {
    const repeat = count(rest[0], 1, 999999999);
    return [`${sequence} ${time(await readBinary(n), first, repeat)}\n`];
@end@
  }
  throw new Trouble(NOT_UNDERSTOOD);
}

process.stdout.write(`${JSON.stringify(description)}\n`);
for (let line; (line = await readLine()) !== null; ) {
  let reply;
  try {
    reply = await answer(line);
  } catch (error) {
    if (!(error instanceof Trouble)) throw error;
    reply = [`error ${error.message}\n`];
  }
  process.stdout.write(Buffer.concat(reply.map((part) => Buffer.from(part))));
}
