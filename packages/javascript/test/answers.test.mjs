// Answers that are known without computing: tangencies at the waist, and what each kind of row says.
import assert from "node:assert/strict";
import { test } from "node:test";

import * as hypcheck from "../index.mjs";

const { classify, classifyPassages, clearance, passage, position } = hypcheck;
const tower = { alpha: 2, gamma: 17.8, b: 0.25, d: 0.15 };

test("a spheroid at the waist touches from outside and from inside exactly", () => {
  assert.equal(position(tower, [2.25, 0, 0]), 0);
  assert.equal(position(tower, [2.2500000000000004, 0, 0]), 1);
  assert.equal(position(tower, [0, -1.75, 0]), 0);
  assert.equal(position(tower, [0, -1, 0]), -1);
});

test("an axis counts and its length does not", () => {
  const sizes = { alpha: 2, gamma: 5, b: 0.25, d: 1 };
  assert.equal(position(sizes, [2.5, 0, 0]), 1);
  assert.equal(position(sizes, [2.5, 0, 0], { axis: [-3, 0, 0] }), 0);
});

test("above an end is exterior, and a flat end is touched", () => {
  assert.equal(position(tower, [0, 0, 1.1], { zMin: -1, zMax: 1 }), 1);
  assert.equal(position(tower, [0, 0, 1.1], { zMin: -1, zMax: 1, solid: true }), 0);
});

test("a way through the wall hits, and one beside it is clear", () => {
  const { hit, notBefore } = passage(tower, [9.5, 0, 0], [0, 0, 0]);
  assert.equal(hit, true);
  assert.ok(notBefore > 0.76 && notBefore < 0.77); // 7.25 of 9.5
  assert.equal(passage(tower, [9.5, 0, 0], [9.5, 4, 3]).hit, false);
  assert.equal(passage(tower, [0, 0, 0], [0, 0, 30], { zMax: 17.8 }).hit, false); // out through the opening
});

test("many rows are answered as one is, also more than the memory held", () => {
  const row = [2, 17.8, 0.25, 0.15, 2.25, 0, 0], n = 300000;
  const rows = new Float64Array(7 * n);
  for (let k = 0; k < n; k++) rows.set(row, 7 * k);
  rows[7 * 17 + 4] = NaN;
  const answers = classify(rows);
  assert.equal(answers.length, n);
  assert.equal(answers[17], hypcheck.INVALID);
  assert.equal(answers.filter((answer) => answer === 0).length, n - 1);
  assert.deepEqual([...classifyPassages([2, 17.8, 0.25, 0.15, 9, 0, 0, 0, 0, 0]).hits], [1]);
  assert.deepEqual([...classify([])], []);
});

test("a clearance encloses the distance at the waist", () => {
  const found = clearance(tower, [9.25, 0, 0]);
  assert.equal(found.position, 1);
  assert.ok(found.distanceLower <= 7 && 7 <= found.distanceUpper && found.distanceUpper < 7 + 1e-6);
  assert.ok(Math.abs(found.nearest[0] - 2) < 1e-3 && found.nearest.length === 3);
});

test("what is not valid is named", () => {
  const said = (call, text) => assert.throws(call, { name: "RangeError", message: text });
  said(() => position({ ...tower, b: 0 }, [9, 0, 0]), "b is 0; it must be finite and greater than 0");
  said(() => position(tower, [9, NaN, 0]), "center[1] is NaN; it must be finite");
  said(() => position(tower, [9, 0]), "center is 9,0; it must be three numbers: x, y, z");
  said(() => position(tower, [9, 0, 0], { axis: [0, 0, 0] }), "axis is 0, 0, 0; it must have a direction");
  said(() => position(tower, [9, 0, 0], { zMin: 1, zMax: 1 }), "zMax is 1; it must be a number greater than zMin, 1");
  said(() => classify([1, 2, 3]), "there are 3 numbers; there must be 7 a row");
  said(() => classify([], { width: 8 }), "width is 8; it must be one of 7, 10, 13");
});

test("the version is the package's", async () => {
  const { default: manifest } = await import("../package.json", { with: { type: "json" } });
  assert.equal(hypcheck.version, manifest.version);
});
