// What every adapter in JavaScript shares: the scene's files, and the protocol of commands (docs/protocol.md).
//
// Import it before the engine: standard output is for replies alone, and console.log goes to standard error. Beside the
// protocol it understands `distance SEQ N tilted-text`: N lines of one decimal follow, the signed distance as the engine
// reports it, NaN where it reports none.
import { readFileSync, readSync, writeSync } from 'node:fs';
import { join } from 'node:path';

// Whether the engine is asked at the tightest settings that it offers; else at those that it has by default.
export const tightest = process.argv[3] === 'tightest';

console.log = console.info = console.warn = console.error;

// The scene in a folder: α, γ, b, d; the hyperboloid's mesh; points on the spheroid, for those that take its hull.
export function readScene(folder) {
  const [alpha, gamma, b, d] = readFileSync(join(folder, 'sizes.txt'), 'utf8').trim().split(/\s+/).map(Number);
  const { vertices, triangles } = off(join(folder, 'surface.off'));
  return { sizes: [alpha, gamma, b, d], b, d, round: b === d, vertices, triangles, body: off(join(folder, 'body.off')).vertices };
}

function off(path) {
  const lines = readFileSync(path, 'utf8').split('\n');
  const [count, faces] = lines[1].split(' ').map(Number);
  const vertices = lines.slice(2, 2 + count).map((line) => line.split(' ').map(Number));
  return { vertices, triangles: lines.slice(2 + count, 2 + count + faces).map((line) => line.split(' ').slice(1, 4).map(Number)) };
}

// The rotation that takes the z axis to a line along an axis.
function turn(axis) {
  const length = Math.hypot(...axis);
  let [x, y, z] = axis.map((each) => each / length);
  if (z < 0) [x, y, z] = [-x, -y, -z]; // the other end of the same line
  const half = Math.hypot(1 + z, x, y);
  return { x: -y / half, y: x / half, z: 0, w: (1 + z) / half };
}

let waiting = Buffer.alloc(0);

function more() {
  const chunk = Buffer.alloc(1 << 16);
  const got = readSync(0, chunk, 0, chunk.length, null);
  waiting = Buffer.concat([waiting, chunk.subarray(0, got)]);
  return got > 0;
}

function line() {
  let end;
  while ((end = waiting.indexOf(10)) < 0) if (!more()) return null;
  const text = waiting.toString('latin1', 0, end);
  waiting = waiting.subarray(end + 1);
  return text;
}

function raw(size) {
  while (waiting.length < size) if (!more()) return null;
  const bytes = waiting.subarray(0, size);
  waiting = waiting.subarray(size);
  return bytes;
}

function say(bytes) {
  for (let rest = Buffer.from(bytes); rest.length > 0; ) {
    try {
      rest = rest.subarray(writeSync(1, rest));
    } catch (error) {
      if (error.code !== 'EAGAIN') throw error; // a full pipe: try again
    }
  }
}

function pose(row) {
  return { center: { x: row[4], y: row[5], z: row[6] }, turn: turn(row.slice(7)), axis: row.slice(7) };
}

function poses(count, form) {
  if (!form.endsWith('binary')) return Array.from({ length: count }, () => pose(line().split(' ').map(Number)));
  const bytes = raw(80 * count);
  const row = (place) => Array.from({ length: 10 }, (_, column) => bytes.readDoubleLE(80 * place + 8 * column));
  return Array.from({ length: count }, (_, place) => pose(row(place)));
}

function reply(word, number, rest, asked, answer) {
  if (word === 'time') {
    const began = process.hrtime.bigint();
    let total = 0;
    for (let turn = 0; turn < Number(rest[0]); turn++) {
      total = 0;
      for (const each of asked) total += Number(answer(each));
    }
    return say(`${number} ${process.hrtime.bigint() - began} ${total}\n`);
  }
  const values = asked.map((each) => Number(answer(each)));
  const head = `${number} ${asked.length}\n`;
  if (rest.at(-1).endsWith('binary')) return say(Buffer.concat([Buffer.from(head), Buffer.from(values)]));
  return say(head + values.map((value) => `${value}\n`).join(''));
}

// Answers questions until standard input ends; `touches` and `distance` take a pose.
export function serve(scene, name, version, precision, touches, distance, tilt = true) {
  const settings = [{ sizes: scene.sizes, ...(tilt ? { axis: 'free' } : { axis: [0, 0, 1] }) }];
  const described = { protocol: 1, name, version, language: 'javascript', precision, question: 'contact', tilt: true };
  say(`${JSON.stringify({ ...described, binary: true, time: true, domain: { settings } })}\n`);
  for (let asked; (asked = line()) !== null; ) {
    const [word, number, count, ...rest] = asked.trim().split(' ');
    const these = poses(Number(count), rest.at(-1));
    try {
      reply(word, number, rest, these, word === 'distance' ? distance : touches);
    } catch (error) {
      say(`error ${String(error).replaceAll('\n', ' ').slice(0, 4000)}\n`);
    }
  }
}
