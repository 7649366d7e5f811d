/* The position of a spheroid beside a hyperboloid, by the definition alone and in GMP's whole numbers: exterior where
   S + l H is positive definite for some l > 0, interior where it is for some l < 0, else contact (docs/mathematics.md,
   "General position"). Between two neighbouring real roots of det(S + l H) the matrix has one signature. So Sturm's
   sequence of the squarefree part separates the roots, and Sylvester's criterion is asked at numbers between them. Nothing
   of the kernel's formulas is used: no g, no discriminant, no pole. */

#include <gmp.h>

enum { DEGREE = 4, POINTS = 4000 };

typedef struct {
    int degree; /* -1 for 0 */
    mpz_t c[DEGREE + 1];
} polynomial;

static void make(polynomial *f) {
    int i;
    f->degree = -1;
    for (i = 0; i <= DEGREE; i++) mpz_init(f->c[i]);
}

static void unmake(polynomial *f) {
    int i;
    for (i = 0; i <= DEGREE; i++) mpz_clear(f->c[i]);
}

static void copy(polynomial *to, const polynomial *from) {
    int i;
    to->degree = from->degree;
    for (i = 0; i <= DEGREE; i++) mpz_set(to->c[i], from->c[i]);
}

/* Without what all coefficients have in common; the sign stays. */
static void reduce(polynomial *f) {
    mpz_t common;
    int i;
    while (f->degree >= 0 && mpz_sgn(f->c[f->degree]) == 0) f->degree--;
    mpz_init(common);
    for (i = 0; i <= f->degree; i++) mpz_gcd(common, common, f->c[i]);
    if (mpz_sgn(common))
        for (i = 0; i <= f->degree; i++) mpz_divexact(f->c[i], f->c[i], common);
    mpz_clear(common);
}

static void derive(polynomial *of, const polynomial *f) {
    int i;
    of->degree = f->degree - 1;
    for (i = 1; i <= f->degree; i++) mpz_mul_ui(of->c[i - 1], f->c[i], (unsigned long)i);
    reduce(of);
}

/* The remainder of f by g, times a positive number; the quotient likewise, where it is wanted and the remainder is 0. */
static void divide(polynomial *rest, polynomial *quotient, const polynomial *f, const polynomial *g) {
    const mpz_t *lead = &g->c[g->degree];
    mpz_t square, factor;
    int i, shift;
    mpz_inits(square, factor, NULL);
    mpz_mul(square, *lead, *lead);
    copy(rest, f);
    if (quotient) {
        for (i = 0; i <= DEGREE; i++) mpz_set_ui(quotient->c[i], 0);
        quotient->degree = f->degree - g->degree;
    }
    while (rest->degree >= g->degree) {
        shift = rest->degree - g->degree;
        mpz_mul(factor, rest->c[rest->degree], *lead);
        for (i = 0; i <= rest->degree; i++) mpz_mul(rest->c[i], rest->c[i], square);
        for (i = 0; i <= g->degree; i++) mpz_submul(rest->c[i + shift], factor, g->c[i]);
        if (quotient) {
            for (i = 0; i <= quotient->degree; i++) mpz_mul(quotient->c[i], quotient->c[i], square);
            mpz_add(quotient->c[shift], quotient->c[shift], factor);
        }
        while (rest->degree >= 0 && mpz_sgn(rest->c[rest->degree]) == 0) rest->degree--;
    }
    reduce(rest);
    if (quotient) reduce(quotient);
    mpz_clears(square, factor, NULL);
}

static int sign_at(const polynomial *f, const mpq_t at) {
    mpz_t total, scale;
    int i, sign;
    mpz_init_set_ui(total, 0);
    mpz_init_set_ui(scale, 1);
    for (i = f->degree; i >= 0; i--) {
        mpz_mul(total, total, mpq_numref(at));
        mpz_addmul(total, f->c[i], scale);
        mpz_mul(scale, scale, mpq_denref(at));
    }
    sign = mpz_sgn(total);
    mpz_clears(total, scale, NULL);
    return sign;
}

typedef struct {
    int length;
    polynomial f[DEGREE + 1];
} chain;

static void make_chain(chain *sturm, const polynomial *f) {
    polynomial common, rest;
    int i;
    make(&common), make(&rest);
    for (i = 0; i <= DEGREE; i++) make(sturm->f + i);
    copy(&common, f);
    derive(&rest, f);
    while (rest.degree >= 0) { /* Euclid */
        polynomial next;
        make(&next);
        divide(&next, NULL, &common, &rest);
        copy(&common, &rest), copy(&rest, &next);
        unmake(&next);
    }
    divide(&rest, sturm->f, f, &common); /* without multiple roots */
    derive(sturm->f + 1, sturm->f);
    for (sturm->length = 2; sturm->f[sturm->length - 1].degree > 0; sturm->length++) {
        polynomial *const next = sturm->f + sturm->length;
        divide(next, NULL, next - 2, next - 1);
        for (i = 0; i <= next->degree; i++) mpz_neg(next->c[i], next->c[i]);
    }
    unmake(&common), unmake(&rest);
}

static void unmake_chain(chain *sturm) {
    int i;
    for (i = 0; i <= DEGREE; i++) unmake(sturm->f + i);
}

static int changes_at(const chain *sturm, const mpq_t at) {
    int i, changes = 0, before = 0;
    for (i = 0; i < sturm->length; i++) {
        const int sign = sign_at(sturm->f + i, at);
        if (sign && before && sign != before) changes++;
        if (sign) before = sign;
    }
    return changes;
}

/* A number between two of one sign: a power of two where they are far apart. */
static void between(mpq_t middle, const mpq_t low, const mpq_t high) {
    const long one = (long)mpz_sizeinbase(mpq_numref(low), 2) - (long)mpz_sizeinbase(mpq_denref(low), 2);
    const long other = (long)mpz_sizeinbase(mpq_numref(high), 2) - (long)mpz_sizeinbase(mpq_denref(high), 2);
    const long half = (one + other) / 2;
    mpq_add(middle, low, high);
    mpq_div_2exp(middle, middle, 1);
    if (labs(one - other) < 2) return;
    mpq_set_si(middle, mpq_sgn(low), 1);
    if (half >= 0) mpq_mul_2exp(middle, middle, (unsigned long)half);
    else mpq_div_2exp(middle, middle, (unsigned long)-half);
}

typedef struct {
    mpz_t S[4][4], H[4]; /* H is diagonal */
} pencil;

static void determinant(mpz_t value, const pencil *pair, const int *kept, int size) {
    mpz_t part;
    int k, i, rest[4];
    if (size == 0) {
        mpz_set_ui(value, 1);
        return;
    }
    mpz_init(part);
    mpz_set_ui(value, 0);
    if (size == 1) mpz_set(value, pair->S[kept[0]][kept[0]]);
    else if (size == 2) {
        mpz_mul(value, pair->S[kept[0]][kept[0]], pair->S[kept[1]][kept[1]]);
        mpz_submul(value, pair->S[kept[0]][kept[1]], pair->S[kept[1]][kept[0]]);
    } else { /* by permutations: Leibniz */
        int p[4], count = 1, at;
        for (i = 2; i <= size; i++) count *= i;
        for (at = 0; at < count; at++) {
            int code = at, odd = 0;
            for (i = 0; i < size; i++) rest[i] = i;
            for (i = 0; i < size; i++) {
                const int choice = code % (size - i);
                code /= size - i;
                p[i] = rest[choice];
                for (k = choice; k + 1 < size - i; k++) rest[k] = rest[k + 1];
                odd ^= choice & 1;
            }
            mpz_set(part, pair->S[kept[0]][kept[p[0]]]);
            for (i = 1; i < size; i++) mpz_mul(part, part, pair->S[kept[i]][kept[p[i]]]);
            if (odd) mpz_sub(value, value, part);
            else mpz_add(value, value, part);
        }
    }
    mpz_clear(part);
}

/* det(S + l H): a subset of the diagonal gives l's, the minor of the others the rest. */
static void characteristic(polynomial *f, const pencil *pair) {
    mpz_t minor;
    int subset, i;
    mpz_init(minor);
    f->degree = 4;
    for (subset = 0; subset < 16; subset++) {
        int kept[4], size = 0, power = 0;
        for (i = 0; i < 4; i++)
            if (!(subset >> i & 1)) kept[size++] = i;
        determinant(minor, pair, kept, size);
        for (i = 0; i < 4; i++)
            if (subset >> i & 1) mpz_mul(minor, minor, pair->H[i]), power++;
        mpz_add(f->c[power], f->c[power], minor);
    }
    mpz_clear(minor);
    reduce(f);
}

/* Whether S + l H is positive definite: Sylvester's criterion, the minors by Bareiss' elimination. */
static int positive_definite(const pencil *pair, const mpq_t at) {
    mpz_t m[4][4], last;
    int i, j, k, positive = 1;
    mpz_init_set_ui(last, 1);
    for (i = 0; i < 4; i++)
        for (j = 0; j < 4; j++) {
            mpz_init(m[i][j]);
            mpz_mul(m[i][j], pair->S[i][j], mpq_denref(at));
            if (i == j) mpz_addmul(m[i][j], pair->H[i], mpq_numref(at));
        }
    for (k = 0; k < 4 && positive; k++) {
        positive = mpz_sgn(m[k][k]) > 0;
        for (i = k + 1; i < 4 && positive; i++)
            for (j = k + 1; j < 4; j++) {
                mpz_mul(m[i][j], m[i][j], m[k][k]);
                mpz_submul(m[i][j], m[i][k], m[k][j]);
                mpz_divexact(m[i][j], m[i][j], last);
            }
        mpz_set(last, m[k][k]);
    }
    for (i = 0; i < 4; i++)
        for (j = 0; j < 4; j++) mpz_clear(m[i][j]);
    mpz_clear(last);
    return positive;
}

/* A power of two above 1 + |each coefficient over the first|, hence above every root. */
static void bound(mpq_t above, const polynomial *f, int reversed) {
    const mpz_t *lead = &f->c[reversed ? 0 : f->degree];
    size_t most = 1;
    int i;
    for (i = 0; i <= f->degree; i++)
        if (mpz_sizeinbase(f->c[i], 2) > most) most = mpz_sizeinbase(f->c[i], 2);
    mpq_set_ui(above, 1, 1);
    mpq_mul_2exp(above, above, most - mpz_sizeinbase(*lead, 2) + 3);
}

/* The side on which some number between the roots makes S + l H positive definite; 0 where none does. */
static int side_of(const pencil *pair) {
    static mpq_t low[POINTS], high[POINTS];
    static int made = 0;
    polynomial f;
    chain sturm;
    mpq_t middle;
    int waiting = 0, found = 0, i;
    for (; made < POINTS; made++) mpq_inits(low[made], high[made], NULL);
    make(&f);
    characteristic(&f, pair);
    make_chain(&sturm, &f);
    bound(high[0], sturm.f, 0);
    bound(low[0], sturm.f, 1);
    mpq_inv(low[0], low[0]);
    mpq_neg(low[1], high[0]);
    mpq_neg(high[1], low[0]);
    waiting = 2;
    mpq_init(middle);
    for (i = 0; i < 2 && !found; i++) { /* beyond all roots, and between them and 0 */
        if (positive_definite(pair, low[i])) found = mpq_sgn(low[i]);
        if (positive_definite(pair, high[i])) found = mpq_sgn(high[i]);
    }
    while (waiting && !found) {
        const int at = --waiting;
        if (changes_at(&sturm, low[at]) - changes_at(&sturm, high[at]) < 2) continue;
        if (waiting + 2 > POINTS) abort();
        between(middle, low[at], high[at]);
        if (sign_at(sturm.f, middle) == 0) {
            mpq_add(middle, low[at], high[at]);
            mpq_div_2exp(middle, middle, 1);
        }
        while (sign_at(sturm.f, middle) == 0) {
            mpq_add(middle, low[at], middle);
            mpq_div_2exp(middle, middle, 1);
        }
        if (positive_definite(pair, middle)) found = mpq_sgn(middle);
        mpq_set(high[at + 1], high[at]);
        mpq_set(low[at + 1], middle);
        mpq_set(high[at], middle);
        waiting += 2;
    }
    mpq_clear(middle);
    unmake(&f);
    unmake_chain(&sturm);
    return found;
}

/* The row in whole numbers without common divisors: lengths in one unit, the axis in another. Where it does not lean, heights
   may have a unit of their own: dividing them by it moves no point of one surface off another. */
static void whole(mpz_t n[10], const mpq_t row[10]) {
    static const int units[2][10] = {{0, 1, 0, 1, 0, 0, 1, 2, 2, 2}, {0, 0, 0, 0, 0, 0, 0, 2, 2, 2}};
    const int *const unit_of = units[mpq_sgn(row[7]) || mpq_sgn(row[8])];
    mpz_t unit, common;
    int i, k;
    mpz_inits(unit, common, NULL);
    for (i = 0; i < 10; i++) mpz_init(n[i]);
    for (k = 0; k < 3; k++) {
        mpz_set_ui(unit, 1);
        mpz_set_ui(common, 0);
        for (i = 0; i < 10; i++)
            if (unit_of[i] == k) mpz_lcm(unit, unit, mpq_denref(row[i]));
        for (i = 0; i < 10; i++)
            if (unit_of[i] == k) {
                mpz_divexact(n[i], unit, mpq_denref(row[i]));
                mpz_mul(n[i], n[i], mpq_numref(row[i]));
                mpz_gcd(common, common, n[i]);
            }
        for (i = 0; i < 10; i++)
            if (unit_of[i] == k && mpz_sgn(common)) mpz_divexact(n[i], n[i], common);
    }
    mpz_clears(unit, common, NULL);
}

/* The position of alpha, gamma, b, d, x, y, z, axis_x, axis_y, axis_z; the sizes are > 0 and the axis is not 0. */
static int true_position(const mpq_t row[10]) {
    mpz_t n[10], q, t, w, part;
    pencil pair;
    int i, j, side;
    mpz_inits(q, t, w, part, NULL);
    whole(n, row);
    for (i = 0; i < 4; i++) {
        for (j = 0; j < 4; j++) mpz_init_set_ui(pair.S[i][j], 0);
        mpz_init(pair.H[i]);
    }
    mpz_mul(q, n[2], n[2]);
    mpz_mul(t, n[3], n[3]);
    for (i = 7; i < 10; i++) mpz_addmul(w, n[i], n[i]);
    /* b² d² w times I/b² + (1/d² - 1/b²) v v'/w */
    mpz_sub(part, q, t);
    for (i = 0; i < 3; i++)
        for (j = 0; j < 3; j++) {
            mpz_mul(pair.S[i][j], n[7 + i], n[7 + j]);
            mpz_mul(pair.S[i][j], pair.S[i][j], part);
            if (i == j) mpz_addmul(pair.S[i][j], t, w);
        }
    for (i = 0; i < 3; i++) {
        for (j = 0; j < 3; j++) mpz_submul(pair.S[i][3], pair.S[i][j], n[4 + j]);
        mpz_set(pair.S[3][i], pair.S[i][3]);
        mpz_submul(pair.S[3][3], pair.S[i][3], n[4 + i]);
    }
    mpz_mul(part, q, t);
    mpz_submul(pair.S[3][3], part, w);
    /* alpha² gamma² times diag(1/alpha², 1/alpha², -1/gamma², -1) */
    mpz_mul(pair.H[0], n[1], n[1]);
    mpz_set(pair.H[1], pair.H[0]);
    mpz_mul(pair.H[2], n[0], n[0]);
    mpz_mul(pair.H[3], pair.H[0], pair.H[2]);
    mpz_neg(pair.H[2], pair.H[2]);
    mpz_neg(pair.H[3], pair.H[3]);
    side = side_of(&pair);
    for (i = 0; i < 4; i++) {
        for (j = 0; j < 4; j++) mpz_clear(pair.S[i][j]);
        mpz_clear(pair.H[i]);
    }
    for (i = 0; i < 10; i++) mpz_clear(n[i]);
    mpz_clears(q, t, w, part, NULL);
    return side;
}
