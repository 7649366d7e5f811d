// Reads rows from standard input, one JSON array; prints what the explorer finds about each, as one JSON array.
import { readFileSync } from "node:fs";
import { runInThisContext } from "node:vm";

const [script, formulas, rule] = process.argv.slice(2).map((path) => readFileSync(path, "utf8"));
const [explorer, ends] = runInThisContext(`${rule}; ${script}; [explorer, ends]`);
const programs = JSON.parse(formulas);
const numbers = (row) => row.map(Number);

const found = JSON.parse(readFileSync(0, "utf8")).map((text, place) => {
  const [row, [low, high, solid]] = [numbers(text.slice(0, 7)), numbers(text.slice(7))];
  const decision = explorer.decide(row);
  const answers = programs.flatMap((formula) =>
    Object.keys(explorer.PRECISIONS).map((precision) => explorer.answerOf(formula, row, precision)),
  );
  const gap = place % 16 ? null : explorer.squaredGap(decision.g).map(String); // it takes most of the time
  const roots = explorer.rootsOf(decision).map(String);
  const ended = solid === undefined ? null : ends.position(row, { low, high, solid: solid === 1 }, decision.position);
  return { position: decision.position, ended, tangent: decision.tangent, ring: decision.ring, answers, gap, roots };
});
process.stdout.write(JSON.stringify(found));
