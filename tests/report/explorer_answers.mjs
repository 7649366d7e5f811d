// Reads rows from standard input, one JSON array; prints what the explorer finds about each, as one JSON array.
import { readFileSync } from "node:fs";
import { runInThisContext } from "node:vm";

const [script, formulas] = process.argv.slice(2).map((path) => readFileSync(path, "utf8"));
const explorer = runInThisContext(`${script}; explorer`);
const programs = JSON.parse(formulas);
const numbers = (row) => row.map(Number);

const found = JSON.parse(readFileSync(0, "utf8")).map((text, place) => {
  const row = numbers(text);
  const decision = explorer.decide(row);
  const answers = programs.flatMap((formula) =>
    Object.keys(explorer.PRECISIONS).map((precision) => explorer.answerOf(formula, row, precision)),
  );
  const gap = place % 16 ? null : explorer.squaredGap(decision.g).map(String); // it takes most of the time
  const roots = explorer.rootsOf(decision).map(String);
  return { position: decision.position, tangent: decision.tangent, ring: decision.ring, answers, gap, roots };
});
process.stdout.write(JSON.stringify(found));
