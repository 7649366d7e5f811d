// The explorer: both bodies in the half plane (r, z), a centre to drag, and the answers about them.
// What is exact here is decided in BigInt as truth/exact.py decides it: a float64 is an integer times a power of two.
// The formulas are the programs of derivation/formulas.py, run step by step in float64 and in float32.
"use strict";

const explorer = (() => {
  const SIZES = ["alpha", "gamma", "b", "d"];
  const COLUMNS = [...SIZES, "x", "y", "z"];
  const POSITIONS = { 1: "exterior", 0: "contact", "-1": "interior" };

  // ---- exact: integers alone -------------------------------------------------------------------------------------

  /** The float64 as [mantissa, exponent]: mantissa times 2 to the exponent is the very number. */
  function dyadic(value) {
    const view = new DataView(new ArrayBuffer(8));
    view.setFloat64(0, value);
    const bits = view.getBigUint64(0);
    const biased = Number((bits >> 52n) & 2047n);
    const fraction = bits & ((1n << 52n) - 1n);
    const mantissa = biased ? fraction | (1n << 52n) : fraction;
    return [value < 0 ? -mantissa : mantissa, Math.max(biased, 1) - 1075];
  }

  /** The values times one power of two that makes each of them an integer. */
  function integers(...values) {
    const pairs = values.map(dyadic);
    const least = Math.min(...pairs.map(([mantissa, exponent]) => (mantissa ? exponent : Infinity)));
    return pairs.map(([mantissa, exponent]) => (mantissa ? mantissa << BigInt(exponent - least) : 0n));
  }

  /** N g(λ) = n3 λ³ + n2 λ² + n1 λ + n0, the poles −A = −p/q and B = s/t, R = x² + y² and S = z²: all integers. */
  function cubic([alpha, gamma, b, d, x, y, z]) {
    const [alpha_, b_, x_, y_] = integers(alpha, b, x, y);
    const [gamma_, d_, z_] = integers(gamma, d, z);
    const [p, q, R] = [alpha_ * alpha_, b_ * b_, x_ * x_ + y_ * y_];
    const [s, t, S] = [gamma_ * gamma_, d_ * d_, z_ * z_];
    return {
      p, q, R, s, t, S,
      n3: q * t,
      n2: (p + q - R) * t - (s + S) * q,
      n1: p * (t - s - S) + s * (R - q),
      n0: -p * s,
      wide: alpha_ >= b_, // α/b ≥ 1
      tall: s * b_ >= alpha_ * t, // (γ/d)² ≥ α/b
    };
  }

  /** The exact position: g > 0 somewhere in (0, B), somewhere in (−A, 0), or nowhere between the poles. */
  function positionOf({ n3, n2, n1, n0, p, q, s, t }) {
    const h = n2 * n2 - 3n * n3 * n1;
    if (h <= 0n) return 0; // g never falls: it has no local maximum
    let side = 1;
    if (n1 > 0n && n2 < 0n) { // the local maximum is at λ > 0
      const beyond = -(n2 * t + 3n * n3 * s); // it is below B exactly if beyond < t √h
      if (beyond >= 0n && beyond * beyond >= t * t * h) return 0;
    } else {
      const above = 3n * n3 * p - n2 * q; // it is above −A exactly if above > q √h
      if (above <= 0n || above * above <= q * q * h) return 0;
      side = -1;
    }
    const w = n2 * (2n * n2 * n2 - 9n * n3 * n1) + 27n * n3 * n3 * n0;
    return w > 0n || 4n * h * h * h > w * w ? side : 0;
  }

  /** N⁴ Δ. */
  function discriminantOf({ n3, n2, n1, n0 }) {
    return n1 * n1 * (n2 * n2 - 4n * n3 * n1) + n0 * (n2 * (18n * n3 * n1 - 4n * n2 * n2) - 27n * n3 * n3 * n0);
  }

  /** The double root of g as [numerator, denominator], if Δ = 0 and there is no triple one; else null. */
  function doubleRoot({ n3, n2, n1, n0 }) {
    const bottom = 2n * (n2 * n2 - 3n * n3 * n1);
    return bottom ? [9n * n3 * n0 - n1 * n2, bottom] : null;
  }

  /** Whether a pair in contact only touches: its double root lies in [−A, 0) or (0, B]. */
  function isTangent(g, discriminant) {
    if (discriminant !== 0n) return false;
    const root = doubleRoot(g);
    if (root === null) return -g.n2 * g.t === 3n * g.n3 * g.s; // triple, at B
    const [top, bottom] = root;
    return top < 0n ? top * g.q + g.p * bottom >= 0n : g.s * bottom - top * g.t >= 0n;
  }

  /** All that is exact about a row of seven numbers. */
  function decide(row) {
    const g = cubic(row);
    const position = positionOf(g);
    const discriminant = discriminantOf(g);
    const tangent = position === 0 && isTangent(g, discriminant);
    return { g, position, discriminant, tangent, ring: position === 1 && discriminant === 0n };
  }

  // ---- numbers to be shown: rounded, and nothing is decided by them ------------------------------------------------

  const bitLength = (n) => n.toString(16).length * 4;

  /** The quotient of two integers as a float64; ±Infinity beyond the largest. */
  function ratio(numerator, denominator) {
    const shift = 70 - (bitLength(numerator) - bitLength(denominator));
    const [left, right] = [BigInt(Math.max(shift, 0)), BigInt(Math.max(-shift, 0))];
    const quotient = (numerator << left) / (denominator << right);
    const half = Math.trunc(-shift / 2);
    return Number(quotient) * 2 ** half * 2 ** (-shift - half);
  }

  /** c2, c1, c0, Δ, A and B, rounded. */
  function rounded({ g, discriminant }) {
    const over = (n) => ratio(n, g.n3);
    const delta = ratio(discriminant, g.n3 ** 4n);
    return { c2: over(g.n2), c1: over(g.n1), c0: over(g.n0), delta, A: ratio(g.p, g.q), B: ratio(g.s, g.t) };
  }

  /**
   * The clearance in spheroid radii, between two bounds that are proved: the squared distance is the greatest value of
   * the dual function D on (−A, B), D is concave, and D and its slope F are quotients of integers (docs/mathematics.md,
   * "Nearest point and clearance"). λ goes from 0 toward the pole by halves, so F there is at most what it is at 0.
   * Returns [lower, upper] of the squared distance less 1.
   */
  function squaredGap(g, most = 200) {
    const { p, q, R, s, t, S } = g;
    const outside = R * s > p * (s + S); // the centre: then λ > 0
    let place = 0n;
    for (let bits = 0; ; bits += 1) {
      const unit = 1n << BigInt(bits);
      const at = (m) => {
        const [L, K] = outside ? [s * m, t * unit] : [-p * m, q * unit];
        const [T, Z] = [K * p + L * q, K * s - L * t];
        const slope = K * K * (p * R * Z * Z - s * S * T * T) - T * T * Z * Z;
        return { L, K, T, Z, slope: outside ? slope : -slope };
      };
      if (bits > 0) {
        const next = 2n * place + 1n;
        place = at(next).slope > 0n ? next : 2n * place;
      }
      if (bits % 40 !== 0 || bits === 0) continue;
      const { L, K, T, Z, slope } = at(place);
      const product = T * Z;
      const lower = ratio(L * (K * (R * Z - S * T) - product) - K * product, K * product);
      const pole = outside ? [s, t] : [p, q];
      const upper = lower + ratio(slope * pole[0], product * product * pole[1] * unit);
      if (bits >= most || upper - lower <= 1e-7 * Math.abs(lower)) return [lower, upper];
    }
  }

  const radii = (gap) => gap / (1 + Math.sqrt(1 + gap));

  /** The clearance in words. */
  function clearance({ g, tangent }) {
    if (tangent) return "0, the surfaces touch";
    const [lower, upper] = squaredGap(g);
    if (!Number.isFinite(upper)) return "beyond the numbers of float64";
    if (upper - lower <= 1e-6 * Math.abs(lower) || upper === lower) return `${short(radii(lower))} spheroid radii`;
    const bound = radii(Math.max(Math.abs(lower), Math.abs(upper)));
    return `not 0, and within ${short(bound)} spheroid radii of it`;
  }

  /** The real roots of g, rising: rounded, and then moved into the intervals in which they are known to lie. */
  function rootsOf(decision) {
    const { g, position, discriminant } = decision;
    const { c2, c1, c0, A, B } = rounded(decision);
    const crossing = g.n2 < 0n && g.n1 > 0n ? [B, Infinity] : [-Infinity, -A];
    const pair = { 1: [0, B], 0: crossing, "-1": [-A, 0] }[position];
    const into = ([low, high], root) => Math.min(Math.max(root, low), high);
    const last = (root) => into([B, Infinity], root);
    const double = doubleRoot(g);
    if (discriminant === 0n) {
      const root = double ? ratio(...double) : -c2 / 3;
      return [root, root, -c2 - 2 * root].sort((a, b) => a - b);
    }
    const h = Math.sqrt(Math.max(c2 * c2 - 3 * c1, 0));
    if (discriminant > 0n) {
      const cosine = (9 * c2 * c1 - 2 * c2 ** 3 - 27 * c0) / (2 * h ** 3);
      const angle = Math.acos(Math.min(Math.max(cosine, -1), 1)) / 3;
      const [first, second, third] = [2, 1, 0].map((k) => (-c2 + 2 * h * Math.cos(angle - (2 * Math.PI * k) / 3)) / 3);
      const rising = [first, second].sort((a, b) => a - b);
      return [...rising.map((root) => into(pair, root)), last(third)];
    }
    let [low, high] = [B, 2 * Math.max(B, Math.abs(c2), Math.sqrt(Math.abs(c1)), Math.cbrt(Math.abs(c0)))];
    for (let step = 0; step < 80; step += 1) {
      const middle = (low + high) / 2;
      if (((middle + c2) * middle + c1) * middle + c0 > 0) high = middle;
      else low = middle;
    }
    return [low];
  }

  /** The distance from the axis at which Δ = 0 in the plane of the waist with nothing near; NaN if there is no ring. */
  function ringRadius([alpha, gamma, b, d]) {
    const [A, B] = [(alpha / b) ** 2, (gamma / d) ** 2];
    return B * B > A ? b * Math.sqrt((B + 1) * (A / B + 1)) : NaN;
  }

  // ---- the formulas ----------------------------------------------------------------------------------------------

  const OPERATIONS = {
    add: (round, x, y) => round(x + y),
    sub: (round, x, y) => round(x - y),
    mul: (round, x, y) => round(x * y),
    div: (round, x, y) => round(x / y),
    neg: (round, x) => -x,
    abs: (round, x) => Math.abs(x),
    sqrt: (round, x) => round(Math.sqrt(x)),
    gt: (round, x, y) => x > y,
    lt: (round, x, y) => x < y,
    ge: (round, x, y) => x >= y,
    le: (round, x, y) => x <= y,
    eq: (round, x, y) => x === y,
    ne: (round, x, y) => x !== y,
    and: (round, x, y) => x && y,
    or: (round, x, y) => x || y,
    not: (round, x) => !x,
    select: (round, condition, x, y) => (condition ? x : y),
  };

  /** float64 rounds by itself; a sum, product, quotient or root of two float32 rounds rightly by way of float64. */
  const PRECISIONS = { float64: (value) => value, float32: Math.fround };

  /** The value of every step of a program; a step is [name, operation, arguments …]. */
  function run(steps, row, precision) {
    const round = PRECISIONS[precision];
    const values = Object.fromEntries(COLUMNS.map((name, place) => [name, round(row[place])]));
    const look = (argument) => (typeof argument === "number" ? argument : values[argument]);
    for (const [name, operation, ...names] of steps) values[name] = OPERATIONS[operation](round, ...names.map(look));
    return values;
  }

  /** What a formula answers: a position, or 1 for yes and 0 for no. */
  function answerOf(formula, row, precision) {
    return Number(run(formula.steps, row, precision)[formula.answer]);
  }

  function expectedOf(question, position) {
    return question === "position" ? position : Number(POSITIONS[position] === question);
  }

  function inWords(question, answer) {
    if (question === "position") return POSITIONS[answer];
    return `${answer ? "" : "not "}${question}`;
  }

  /** A number to six digits. */
  function short(value) {
    if (!Number.isFinite(value)) return Number.isNaN(value) ? "no number" : value > 0 ? "∞" : "−∞";
    return String(Number(value.toPrecision(6))).replace("-", "−").replace("e+", "e");
  }

  /** Whether each number is 0 or a normal number of the precision, as it must be for a formula to be asked. */
  function fits(row, precision) {
    const least = { float64: 2 ** -1022, float32: 2 ** -126 }[precision];
    const round = PRECISIONS[precision];
    return row.every((value) => value === 0 || (Math.abs(value) >= least && Number.isFinite(round(value))));
  }

  return {
    COLUMNS, SIZES, POSITIONS, PRECISIONS,
    answerOf, clearance, decide, expectedOf, fits, integers, inWords, ringRadius, rootsOf, rounded, run, short, squaredGap,
  };
})();

// ---- the page ----------------------------------------------------------------------------------------------------

/** The explorer of an element: its inputs, its picture and its answers follow one row of seven numbers. */
function explored(place) {
  const { COLUMNS, SIZES, POSITIONS, PRECISIONS, short } = explorer;
  const [WIDTH, HEIGHT] = [640, 480]; // of the picture, in its own units
  const formulas = JSON.parse(place.dataset.formulas);
  const find = (name) => place.querySelector(`[data-is="${name}"]`);
  const [picture, line, said, origin] = ["picture", "line", "said", "origin"].map(find);
  const fields = Object.fromEntries(COLUMNS.map((name) => [name, find(name)]));
  const heights = { z_min: find("z_min"), z_max: find("z_max") };
  const sliders = Object.fromEntries(SIZES.map((name) => [name, find(`${name}-slider`)]));
  let row = place.dataset.row.split(" ").map(Number);
  let wallEnds = { low: -Infinity, high: Infinity, solid: false };
  let view = { r: 0, z: 0, scales: [1, 1] }; // the middle of the picture, and its units for one length across and up

  function element(name, attributes = {}, text = "") {
    const made = document.createElementNS("http://www.w3.org/2000/svg", name);
    Object.entries(attributes).forEach(([key, value]) => made.setAttribute(key, value));
    made.textContent = text;
    return made;
  }

  const radius = () => Math.hypot(row[4], row[5]);
  const limited = (value) => Math.min(Math.max(value, -1e5), 1e5); // browsers draw no farther
  const across = (r) => limited(WIDTH / 2 + (r - view.r) * view.scales[0]);
  const up = (z) => limited(HEIGHT / 2 - (z - view.z) * view.scales[1]);
  const wall = (z) => row[0] * Math.hypot(1, z / row[1]);

  /**
   * Let the picture show r from `left` to `right` and z from `low` to `high`. If one is far longer, each has a scale of
   * its own: thin bodies would not be seen, and bodies that touch do so in any scale (Theorem 1 of the paper).
   */
  function show(left, right, low, high) {
    const scales = [(0.9 * WIDTH) / (right - left), (0.9 * HEIGHT) / (high - low)];
    const [least, greatest] = [Math.min(...scales), Math.max(...scales)];
    if (!(least > 0 && Number.isFinite(greatest))) return;
    view = { r: (left + right) / 2, z: (low + high) / 2, scales: greatest > 4 * least ? scales : [least, least] };
  }

  function showAll() {
    const [r, z, b, d, alpha] = [radius(), row[6], row[2], row[3], row[0]];
    show(-0.1 * alpha, 1.1 * Math.max(alpha, r + b), Math.min(z - d, -alpha), Math.max(z + d, alpha));
  }

  function showSpheroid() {
    const [r, z, b, d] = [radius(), row[6], row[2], row[3]];
    show(r - 2 * b, r + 2 * b, z - 2 * d, z + 2 * d);
  }

  function zoom(factor) {
    view = { r: radius(), z: row[6], scales: view.scales.map((scale) => scale * factor) };
    update();
  }

  // ---- the pictures

  /** The wall on one side of the axis, of what the picture shows between its ends. */
  function meridian(side) {
    const half = HEIGHT / 2 / view.scales[1];
    const [low, high] = [Math.max(view.z - half, wallEnds.low), Math.min(view.z + half, wallEnds.high)];
    const points = low > high ? [] : Array.from({ length: 97 }, (_, step) => low + (step / 96) * (high - low));
    return points.map((z) => `${across(side * wall(z)).toFixed(2)},${up(z).toFixed(2)}`);
  }

  /** The ends: a flat end of a solid, or the mouth of an open wall, with what can be dragged in its middle. */
  function endLines() {
    return [wallEnds.low, wallEnds.high].filter(Number.isFinite).flatMap((end) => {
      const [left, right, height] = [across(-wall(end)), across(wall(end)), up(end)];
      const grip = Math.min(Math.max(across(0), 12), WIDTH - 12);
      return [
        element("line", { class: wallEnds.solid ? "end solid" : "end", x1: left, x2: right, y1: height, y2: height }),
        element("rect", { class: "grip", x: grip - 9, y: height - 5, width: 18, height: 10 }),
      ];
    });
  }

  function drawPicture(decision) {
    const [right, left] = [meridian(1), meridian(-1)];
    const [r, z, b, d] = [radius(), row[6], row[2], row[3]];
    const label = (x, y, text, anchor = "start") => element("text", { x, y, "text-anchor": anchor }, text);
    const parts = [
      element("polygon", { class: "inside", points: [...right, ...left.reverse()].join(" ") }),
      element("line", { class: "axis", x1: across(0), x2: across(0), y1: 0, y2: HEIGHT }),
      element("line", { class: "waist", x1: across(-row[0]), x2: across(row[0]), y1: up(0), y2: up(0) }),
      element("polyline", { class: "wall", points: right.join(" ") }),
      element("polyline", { class: "wall", points: left.join(" ") }),
      ...endLines(),
      element("ellipse", {
        class: `body ${POSITIONS[decision.shown] ?? "unknown"}`,
        cx: across(r),
        cy: up(z),
        rx: limited(b * view.scales[0]),
        ry: limited(d * view.scales[1]),
      }),
      element("path", { class: "center", d: `M${across(r) - 7} ${up(z)}h14M${across(r)} ${up(z) - 7}v14` }),
      label(Math.min(Math.max(across(0) + 5, 5), WIDTH - 60), 16, across(0) < 0 ? "← axis" : "axis"),
    ];
    const ring = explorer.ringRadius(row);
    if (Number.isFinite(ring)) {
      parts.push(element("circle", { class: "ring", cx: across(ring), cy: up(0), r: 9 }));
      parts.push(label(across(ring), up(0) + 25, "ring", "middle"));
    }
    const [wide, tall] = view.scales.map((scale) => 10 ** Math.floor(Math.log10((0.4 * WIDTH) / scale)));
    parts.push(element("path", { class: "bar", d: `M12 ${HEIGHT - 12}h${wide * view.scales[0]}` }));
    parts.push(label(18, HEIGHT - 18, short(wide)));
    if (view.scales[0] !== view.scales[1]) {
      parts.push(element("path", { class: "bar", d: `M12 ${HEIGHT - 12}v${-tall * view.scales[1]}` }));
      parts.push(label(18, HEIGHT - 12 - tall * view.scales[1] + 12, `${short(tall)} (heights have a scale of their own)`));
    }
    picture.replaceChildren(...parts);
  }

  /** λ on the line of the roots: −A, 0 and B stand at fixed places, and what lies beyond them is drawn together. */
  function onLine(root, A, B) {
    if (root < -A) return 150 * (A / -root);
    if (root < 0) return 150 + 150 * (1 + root / A);
    return root <= B ? 300 + 170 * (root / B) : 470 + 150 * (1 - B / root);
  }

  function drawLine(decision) {
    const { A, B } = explorer.rounded(decision);
    const roots = explorer.rootsOf(decision);
    const known = roots.every(Number.isFinite) && Number.isFinite(A) && Number.isFinite(B);
    const marks = [["−A", 150], ["0", 300], ["B", 470]].flatMap(([name, x]) => [
      element("path", { class: "axis", d: `M${x} 14v18` }),
      element("text", { x, y: 48, "text-anchor": "middle" }, name),
    ]);
    const shown = known ? roots : [];
    const dots = shown.map((root, at) => {
      const look = root === shown[at - 1] ? { class: "double root", r: 10 } : { class: "root", r: 6 };
      return element("circle", { ...look, cx: onLine(root, A, B), cy: 23 });
    });
    line.replaceChildren(element("path", { class: "wall", d: "M0 23h640" }), ...marks, ...dots);
    const pair = roots.length === 1 ? ", and two that are no real numbers" : "";
    const listed = known ? `${roots.map(short).join(", ")}${pair}` : "beyond the numbers of float64";
    find("roots").textContent = `Roots of g: ${listed}. Poles: −A = ${short(-A)}, B = ${short(B)}. Not to scale.`;
  }

  // ---- the answers

  function fill(name, lines) {
    find(name).replaceChildren(...lines.map((cells) => {
      const made = document.createElement("tr");
      cells.map((each) => [each].flat()).forEach(([text, tone], column) => {
        const cell = document.createElement(column ? "td" : "th");
        if (!column) cell.scope = "row";
        if (tone) cell.className = tone;
        cell.textContent = text;
        made.append(cell);
      });
      return made;
    }));
  }

  function fillNumbers(decision) {
    const { c2, c1, delta } = explorer.rounded(decision);
    const steps = formulas[0].steps;
    const floats = Object.keys(PRECISIONS).map((precision) => explorer.run(steps, row, precision));
    const lines = [["c2", "c2", c2], ["c1", "c1", c1], ["Δ", "delta", delta]];
    fill("numbers", lines.map(([title, step, exact]) => [title, short(exact), ...floats.map((each) => short(each[step]))]));
  }

  /** Fill the table of the formulas; the names of those that are wrong where they claim to be right. */
  function fillFormulas({ g, position }) {
    const wrong = [];
    fill("formulas", formulas.map((formula) => {
      const claims = formula.regimes.every((regime) => (regime === "a>=1" ? g.wide : g.tall));
      const answers = Object.keys(PRECISIONS).map((precision) => {
        if (!explorer.fits(row, precision)) return "not asked: beyond its numbers";
        const answer = explorer.answerOf(formula, row, precision);
        const words = explorer.inWords(formula.question, answer);
        if (answer === explorer.expectedOf(formula.question, position)) return [words, "good"];
        if (!claims) return `${words}: wrong, outside its regimes`;
        wrong.push(`${formula.name} in ${precision}`);
        return [`${words}: wrong`, "bad"];
      });
      return [formula.title, formula.question === "position" ? "position" : `${formula.question}?`, ...answers];
    }));
    return wrong;
  }

  /** Let everything on the page follow the row. */
  function update() {
    const decision = explorer.decide(row);
    const ended = Number.isFinite(wallEnds.low) || Number.isFinite(wallEnds.high);
    decision.shown = ended ? ends.position(row, wallEnds, decision.position) : decision.position;
    const wrong = fillFormulas(decision);
    fillNumbers(decision);
    drawPicture(decision);
    drawLine(decision);
    const ring = decision.ring ? " On the ring: Δ is 0, and nothing touches." : "";
    const errors = wrong.length ? `Wrong: ${wrong.join(", ")}.` : "No formula is wrong where it claims to be right.";
    const clear = ended ? "not computed beside ends" : explorer.clearance(decision);
    const answer = POSITIONS[decision.shown] ?? "not known, these numbers are too long to be decided here";
    const exact = `Exact answer: ${answer}. Clearance: ${clear}.`;
    const whole = `The formulas know no ends; without these it is ${POSITIONS[decision.position]}.`;
    said.textContent = `${exact}${ended ? ` ${whole}` : ""}${ring} ${errors}`;
    find("to-ring").disabled = !Number.isFinite(explorer.ringRadius(row));
    COLUMNS.forEach((name, column) => {
      if (document.activeElement !== fields[name]) fields[name].value = String(row[column]);
      fields[name].removeAttribute("aria-invalid");
    });
    Object.entries({ z_min: wallEnds.low, z_max: wallEnds.high }).forEach(([name, end]) => {
      if (document.activeElement !== heights[name]) heights[name].value = Number.isFinite(end) ? String(end) : "";
      heights[name].removeAttribute("aria-invalid");
    });
    find("solid").checked = wallEnds.solid;
    SIZES.forEach((name, column) => {
      if (document.activeElement !== sliders[name]) sliders[name].value = String(Math.log10(row[column]));
      sliders[name].setAttribute("aria-valuetext", short(row[column]));
    });
  }

  function set(changes) {
    row = row.map((value, column) => changes[COLUMNS[column]] ?? value);
    origin.textContent = "";
    update();
  }

  // ---- what a reader does

  function typed(name) {
    const value = fields[name].value.trim() === "" ? NaN : Number(fields[name].value);
    if (Number.isFinite(value) && (value > 0 || !SIZES.includes(name))) return set({ [name]: value + 0 });
    fields[name].setAttribute("aria-invalid", "true");
    const wanted = SIZES.includes(name) ? "a number greater than 0" : "a number";
    const label = fields[name].labels[0].textContent;
    said.textContent = `${label} must be ${wanted} of float64. The picture shows the last numbers that were valid.`;
  }

  /** Let the wall end as the fields say; an empty one is no end. */
  function typedEnds() {
    const [low, high] = ["z_min", "z_max"].map((name) => {
      const { value, validity } = heights[name];
      if (validity.badInput) return NaN;
      return value.trim() === "" ? { z_min: -Infinity, z_max: Infinity }[name] : Number(value) + 0;
    });
    if (low < high && low < Infinity && high > -Infinity) return setEnds({ low, high });
    Object.values(heights).forEach((field) => field.setAttribute("aria-invalid", "true"));
    said.textContent = "z_min must be less than z_max, and both numbers of float64 or empty. The picture shows the last ends that were valid.";
  }

  function setEnds(changes) {
    wallEnds = { ...wallEnds, ...changes };
    origin.textContent = "";
    update();
  }

  /** Ends at the bottom and at the middle of the picture, or none where there are some. */
  function toggleEnds() {
    if (Number.isFinite(wallEnds.low) || Number.isFinite(wallEnds.high)) return setEnds({ low: -Infinity, high: Infinity });
    const digits = (value) => Number(value.toPrecision(3)) + 0;
    const [low, high] = [digits(view.z - (0.4 * HEIGHT) / view.scales[1]), digits(row[6])];
    return setEnds(low < high ? { low, high } : { high });
  }

  /** Move the centre in the half plane: to the distance r from the axis and the height z. */
  function moveTo(r, z) {
    set({ x: Math.max(r, 0), y: 0, z });
  }

  /** Which end has its grip under the pointer, "low" or "high", or null. */
  function gripAt(at) {
    const grip = Math.min(Math.max(across(0), 12), WIDTH - 12);
    const near = ["high", "low"].filter((name) => Number.isFinite(wallEnds[name]));
    return near.find((name) => Math.abs(at.x - grip) <= 14 && Math.abs(at.y - up(wallEnds[name])) <= 10) ?? null;
  }

  let held = null; // the end that is dragged, or null: the centre

  function pointed(event) {
    const matrix = picture.getScreenCTM().inverse();
    const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix);
    const [wide, tall] = view.scales;
    const near = (value, scale) => { // a place of the picture is known to a unit of it
      const digit = 10 ** Math.ceil(Math.log10(scale));
      return Number((Math.round(value * digit) / digit).toPrecision(12));
    };
    if (event.type === "pointerdown") held = gripAt(at);
    const z = near(view.z - (at.y - HEIGHT / 2) / tall, tall);
    if (held === null) return moveTo(near(view.r + (at.x - WIDTH / 2) / wide, wide), z);
    if (held === "low" ? z < wallEnds.high : z > wallEnds.low) setEnds({ [held]: z });
  }

  const KEYS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowDown: [0, -1], ArrowUp: [0, 1] };

  function pressed(event) {
    if (event.key === "+" || event.key === "-") zoom(event.key === "+" ? 1.5 : 1 / 1.5);
    if (!(event.key in KEYS) || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    const steps = view.scales.map((scale) => 10 ** Math.round(Math.log10(WIDTH / scale / 50)) / (event.shiftKey ? 100 : 1));
    const [right, higher] = KEYS[event.key];
    const moved = (value, change) => (change ? Number((value + change).toPrecision(12)) : value);
    moveTo(moved(radius(), right * steps[0]), moved(row[6], higher * steps[1]));
  }

  /** Show a case of the run: its row, and where it comes from. */
  function open(numbers, name) {
    row = numbers;
    wallEnds = { low: -Infinity, high: Infinity, solid: false };
    showSpheroid();
    update();
    origin.textContent = `Case ${name}.`;
    place.scrollIntoView();
    picture.focus({ preventScroll: true });
  }

  COLUMNS.forEach((name) => fields[name].addEventListener("input", () => typed(name)));
  Object.values(heights).forEach((field) => field.addEventListener("input", typedEnds));
  find("solid").addEventListener("input", () => setEnds({ solid: find("solid").checked }));
  SIZES.forEach((name) => {
    const slid = () => set({ [name]: Number((10 ** Number(sliders[name].value)).toPrecision(3)) });
    sliders[name].addEventListener("input", slid);
  });
  picture.addEventListener("pointerdown", (event) => {
    picture.setPointerCapture(event.pointerId);
    pointed(event);
  });
  picture.addEventListener("pointermove", (event) => picture.hasPointerCapture(event.pointerId) && pointed(event));
  picture.addEventListener("keydown", pressed);
  const buttons = {
    "to-ring": () => moveTo(explorer.ringRadius(row), 0),
    "to-ends": toggleEnds,
    "show-all": () => (showAll(), update()),
    "show-spheroid": () => (showSpheroid(), update()),
    "zoom-in": () => zoom(1.5),
    "zoom-out": () => zoom(1 / 1.5),
  };
  Object.entries(buttons).forEach(([name, act]) => find(name).addEventListener("click", act));
  place.hidden = false;
  showAll();
  update();
  return open;
}

/** Beside each case of the page a button that opens it in the explorer. */
function openable(open) {
  document.querySelectorAll("code[data-row]").forEach((code) => {
    const button = document.createElement("button");
    button.type = "button";
    button.className = "open";
    button.textContent = "open";
    button.setAttribute("aria-label", `Open ${code.textContent} in the explorer`);
    button.addEventListener("click", () => open(code.dataset.row.split(" ").map(Number), code.textContent));
    code.after(" ", button);
  });
}

if (typeof document !== "undefined") {
  const place = document.querySelector(".explorer");
  if (place) openable(explored(place));
}
