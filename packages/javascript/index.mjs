// The exact position of a spheroid relative to a circular hyperboloid of one sheet, by hypcheck's C header as WebAssembly.
// index.d.ts says what each function takes and gives.
import { base64 } from "./wasm.mjs";

const { instance } = await WebAssembly.instantiate(Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0)));
const library = instance.exports;
const HEAP = Math.ceil(library.__heap_base.value / 16) * 16;
const PAGE = 65536;

export const EXTERIOR = 1, CONTACT = 0, INTERIOR = -1, UNDECIDED = 2, INVALID = 127;

/** Room for arrays of these lengths in bytes, one after the other: where each begins. */
function roomFor(...lengths) {
  let end = HEAP;
  const places = lengths.map((length) => {
    const place = end;
    end += Math.ceil(length / 16) * 16;
    return place;
  });
  const missing = end - library.memory.buffer.byteLength;
  if (missing > 0) library.memory.grow(Math.ceil(missing / PAGE)); // throws RangeError beyond 4 GiB
  return places;
}

const doubles = (place, length) => new Float64Array(library.memory.buffer, place, length);
const bytes = (place, length) => new Int8Array(library.memory.buffer, place, length);

const UPRIGHT = [0, 0, 1];

/** The number of that name. Throws a RangeError that says what it must be. */
function checked(name, value, valid, must) {
  if (typeof value === "number" && valid(value)) return value;
  throw new RangeError(`${name} is ${String(value)}; it must be ${must}`);
}

function sizesOf(given) {
  const size = (name) => checked(name, given?.[name], (value) => value > 0 && value < Infinity, "finite and greater than 0");
  return ["alpha", "gamma", "b", "d"].map(size);
}

function pointOf(name, given) {
  if (given?.length !== 3) throw new RangeError(`${name} is ${String(given)}; it must be three numbers: x, y, z`);
  return Array.from(given, (value, k) => checked(`${name}[${k}]`, value, Number.isFinite, "finite"));
}

function axisOf(given) {
  const axis = pointOf("axis", given);
  if (axis.every((value) => value === 0)) throw new RangeError("axis is 0, 0, 0; it must have a direction");
  return axis;
}

function heightsOf({ zMin = -Infinity, zMax = Infinity, solid = false }) {
  checked("zMin", zMin, (value) => value < Infinity, "a number");
  checked("zMax", zMax, (value) => value > zMin, `a number greater than zMin, ${zMin}`);
  return [zMin, zMax, solid ? 1 : 0];
}

const hasEnds = (options) => options.zMin !== undefined || options.zMax !== undefined || options.solid !== undefined;

/** The numbers behind the centre, or centres, of one row. */
const restOf = (options) => {
  if (hasEnds(options)) return [...axisOf(options.axis ?? UPRIGHT), ...heightsOf(options)];
  return options.axis === undefined ? [] : axisOf(options.axis);
};

export function position(sizes, center, options = {}) {
  const row = [...sizesOf(sizes), ...pointOf("center", center), ...restOf(options)];
  const [answer] = classify(Float64Array.from(row), { width: row.length });
  return answer === UNDECIDED ? null : answer;
}

export function passage(sizes, start, end, options = {}) {
  const row = [...sizesOf(sizes), ...pointOf("start", start), ...pointOf("end", end), ...restOf(options)];
  const { hits, times } = classifyPassages(Float64Array.from(row), { width: row.length });
  return { hit: hits[0] === UNDECIDED ? null : hits[0] === 1, notBefore: times[0] };
}

/** The rows as one array, and how many there are. */
function flat(rows, width, widths) {
  if (!widths.includes(width)) throw new RangeError(`width is ${width}; it must be one of ${widths.join(", ")}`);
  const numbers = rows instanceof Float64Array ? rows : Float64Array.from(rows);
  if (numbers.length % width) throw new RangeError(`there are ${numbers.length} numbers; there must be ${width} a row`);
  return [numbers, numbers.length / width];
}

export function classify(rows, { width = 7 } = {}) {
  const [numbers, n] = flat(rows, width, [7, 10, 13]);
  const [rowsAt, answersAt] = roomFor(8 * numbers.length, n);
  doubles(rowsAt, numbers.length).set(numbers);
  library.hypcheck_classify_columns(n, width, rowsAt, answersAt);
  return bytes(answersAt, n).slice();
}

export function classifyPassages(rows, { width = 10 } = {}) {
  const [numbers, n] = flat(rows, width, [10, 13, 16]);
  const [rowsAt, hitsAt, timesAt] = roomFor(8 * numbers.length, n, 8 * n);
  doubles(rowsAt, numbers.length).set(numbers);
  library.hypcheck_passage_columns(n, width, rowsAt, hitsAt, timesAt);
  return { hits: bytes(hitsAt, n).slice(), times: doubles(timesAt, n).slice() };
}

export function clearance(sizes, center) {
  const row = [...sizesOf(sizes), ...pointOf("center", center)];
  const [rowAt, answerAt, nearAt] = roomFor(8 * row.length, 1, 8 * 11);
  doubles(rowAt, row.length).set(row);
  library.hypcheck_clearance(1, rowAt, answerAt, nearAt);
  const [lower, upper, , distanceLower, distanceUpper, , , , ...nearest] = doubles(nearAt, 11);
  return { position: bytes(answerAt, 1)[0], lower, upper, distanceLower, distanceUpper, nearest };
}

/** The text that ends in 0 at this place. */
function textAt(place) {
  const memory = new Uint8Array(library.memory.buffer);
  return new TextDecoder().decode(memory.subarray(place, memory.indexOf(0, place)));
}

export const version = textAt(library.hypcheck_version());
