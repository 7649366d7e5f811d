
/* ---- a tilted spheroid: exact integers ---- */

@TILTED_POOL@

/* Memory for integers: what is made takes the next limbs, as many as it can need. */
typedef struct {
    hc_limb *next;
} hc_pool;

static hc_integer hc_taken(hc_pool *pool, int limbs) {
    hc_integer number;
    number.sign = 0;
    number.length = 0;
    number.limbs = pool->next;
    pool->next += limbs;
    return number;
}

static hc_integer hc_product(hc_pool *pool, const hc_integer *left, const hc_integer *right) {
    hc_integer product = hc_taken(pool, left->length + right->length);
    hc_multiply(&product, left, right);
    return product;
}

static hc_integer hc_sum(hc_pool *pool, const hc_integer *left, const hc_integer *right, int sign) {
    hc_integer sum = hc_taken(pool, 1 + (left->length < right->length ? right->length : left->length));
    hc_combine(&sum, left, right, sign);
    return sum;
}

static hc_integer hc_multiple(hc_pool *pool, hc_limb factor, const hc_integer *number) {
    hc_integer product = hc_taken(pool, 1 + number->length);
    hc_scale(&product, factor, number);
    return product;
}

/* Moves a number to the pool's next limbs; the pool may have been set back before it, not beyond it. */
static void hc_keep(hc_pool *pool, hc_integer *number) {
    hc_limb *const to = pool->next;
    memmove(to, number->limbs, (size_t)number->length * sizeof *to);
    number->limbs = to;
    pool->next = to + number->length;
}

static int hc_bits_of(const hc_integer *number) {
    hc_limb top;
    int bits;
    if (number->length == 0) return 0;
    top = number->limbs[number->length - 1];
    for (bits = HC_LIMB_BITS * (number->length - 1); top; top >>= 1) bits++;
    return bits;
}

/* The number times 2^shift, cut towards zero. */
static hc_integer hc_shifted(hc_pool *pool, const hc_integer *number, int shift) {
    const int bits = hc_bits_of(number) + shift, length = bits > 0 ? (bits + HC_LIMB_BITS - 1) / HC_LIMB_BITS : 0;
    hc_integer result = hc_taken(pool, length);
    int i;
    for (i = 0; i < length; i++) {
        const int from = i * HC_LIMB_BITS - shift; /* the bit that becomes the lowest one of limb i; the number has more bits */
        const int limb = from < 0 ? -((HC_LIMB_BITS - 1 - from) / HC_LIMB_BITS) : from / HC_LIMB_BITS;
        const int off = from - limb * HC_LIMB_BITS;
        const hc_limb low = limb >= 0 ? number->limbs[limb] : 0;
        const hc_limb high = limb >= -1 && limb + 1 < number->length ? number->limbs[limb + 1] : 0;
        result.limbs[i] = off ? (hc_limb)(low >> off) | (hc_limb)(high << (HC_LIMB_BITS - off)) : low;
    }
    result.length = length;
    result.sign = length ? number->sign : 0;
    return result;
}

/* The bits of a number: those of positive doubles are in the order of the doubles, subnormal and flushed ones too. */
static uint64_t hc_word(double value) {
    uint64_t word;
    memcpy(&word, &value, sizeof word);
    return word;
}

/* Whether the spheroid of a valid row of ten is an upright one: its axis is not tilted, or it is a sphere. */
static int hc_is_upright(const double row[10]) {
    return ((hc_word(row[7]) | hc_word(row[8])) << 1 == 0) || hc_word(row[2]) == hc_word(row[3]);
}

static int hc_has_direction(const double axis[3]) {
    const uint64_t x = hc_word(axis[0]) << 1, y = hc_word(axis[1]) << 1, z = hc_word(axis[2]) << 1;
    const uint64_t infinite = (uint64_t)0x7ff << 53;
    return (x | y | z) != 0 && x < infinite && y < infinite && z < infinite;
}

/* The quartic F = f4 λ⁴ + f3 λ³ + f2 λ² + f1 λ - minus_f0 of a pair, its poles -p/q and the roots -A2 < 0 < B of
   k0 + k1 λ - k2 λ², and the squares s and t that -p s/(q t) = -A2 B is made of. */
typedef struct {
    hc_integer minus_f0, f1, f2, f3, f4, p, q, s, t, k0, k1, k2;
    int oblate;
} hc_quartic;

static hc_quartic hc_quartic_of(hc_pool *pool, const double row[10]) {
    hc_limb *const start = pool->next;
    hc_parts parts[10];
    hc_integer numbers[10];
    hc_quartic pair;
    int i, unit[2] = {4096, 4096};
    for (i = 0; i < 10; i++) {
        parts[i] = hc_parts_of(row[i]);
        unit[i >= 7] = hc_least(unit[i >= 7], parts[i].exponent);
    }
    for (i = 0; i < 10; i++) {
        numbers[i] = hc_taken(pool, parts[i].sign ? (parts[i].exponent - unit[i >= 7] + 64) / HC_LIMB_BITS + 2 : 1);
        hc_in_units(numbers + i, parts[i], unit[i >= 7]);
    }
    {
        const hc_integer alpha = numbers[0], gamma = numbers[1], b = numbers[2], d = numbers[3], x = numbers[4],
                         y = numbers[5], z = numbers[6], axis_x = numbers[7], axis_y = numbers[8], axis_z = numbers[9];
        /* printed from the program "tilted-quartic" */
        @TILTED_QUARTIC@
        /* end of the program "tilted-quartic" */
        hc_integer *kept[12] = {&pair.p, &pair.q, &pair.s, &pair.t, &pair.k0, &pair.k1, &pair.k2, &pair.minus_f0, &pair.f1,
                                &pair.f2, &pair.f3, &pair.f4};
        pair.p = p, pair.q = q, pair.s = s, pair.t = t, pair.k0 = k0, pair.k1 = k1, pair.k2 = k2;
        pair.minus_f0 = minus_f0, pair.f1 = f1, pair.f2 = f2, pair.f3 = f3, pair.f4 = f4;
        pool->next = start;
        for (i = 0; i < 12; i++) hc_keep(pool, kept[i]); /* in the order in which they were made */
    }
    pair.oblate = hc_word(row[2]) > hc_word(row[3]);
    return pair;
}

/* The sign of the discriminant of f4 λ⁴ + ... - minus_f0; 0 also where its size is below 2^least_bits. */
static int hc_discriminant_sign(hc_pool pool, const hc_integer f[5], int least_bits) {
    hc_limb *const start = pool.next;
    const hc_integer minus_f0 = f[0], f1 = f[1], f2 = f[2], f3 = f[3], f4 = f[4];
    hc_integer kept_I, kept_J;
    {
        /* printed from the program "tilted-invariants" */
        @TILTED_INVARIANTS@
        /* end of the program "tilted-invariants" */
        kept_I = I, kept_J = J;
    }
    pool.next = start;
    hc_keep(&pool, &kept_I);
    hc_keep(&pool, &kept_J);
    {
        const hc_integer I = kept_I, J = kept_J;
        /* printed from the program "tilted-discriminant" */
        @TILTED_DISCRIMINANT@
        /* end of the program "tilted-discriminant" */
        return hc_bits_of(&delta) > least_bits ? delta.sign : 0;
    }
}

/* The same from the coefficients cut to HC_CUT_BITS = n bits. With λ in units of a power of two that makes the first and
   the last alike, and all at most 2^n, each is off by less than 1. So I < 16 2^2n is off by less than 2^(n+6),
   J < 137 2^3n by less than 2^(2n+10), and 4 I³ - J² by less than 12 2^(4n+8) 2^(n+6) + 2^(3n+9) 2^(2n+10) < 2^(5n+20). */
static int hc_cut_discriminant_sign(hc_pool pool, const hc_integer f[5]) {
    const int step = (hc_bits_of(f) - hc_bits_of(f + 4)) / 4;
    hc_integer cut[5];
    int i, most = -(1 << 30);
    for (i = 0; i < 5; i++)
        if (f[i].sign && hc_bits_of(f + i) + i * step > most) most = hc_bits_of(f + i) + i * step;
    for (i = 0; i < 5; i++) cut[i] = hc_shifted(&pool, f + i, i * step + HC_CUT_BITS - most);
    return hc_discriminant_sign(pool, cut, 5 * HC_CUT_BITS + 20);
}

/* The sign of k0 + k1 λ - k2 λ² at λ = side 2^power: > 0 between -A2 and B, < 0 outside. */
static int hc_between_poles(hc_pool pool, const hc_quartic *pair, int side, int power) {
    const int up = power > 0 ? power : 0, down = power < 0 ? -power : 0;
    const hc_integer first = hc_shifted(&pool, &pair->k0, 2 * down), second = hc_shifted(&pool, &pair->k1, up + down);
    const hc_integer third = hc_shifted(&pool, &pair->k2, 2 * up), two = hc_sum(&pool, &first, &second, side);
    const hc_integer all = hc_sum(&pool, &two, &third, -1);
    return all.sign;
}

/* Whether three roots of one sign cannot all lie beyond the pole of that side, by their product: the roots' is
   -A1 A2 B, and the fourth root lies beyond the other pole. So three beyond B ask for B² <= max(A1, A2), three beyond
   -min(A1, A2) for min(A1, A2)² <= max(A1, A2). The exponents below are 2^j > √A1 and so on. */
static int hc_product_too_small(hc_pool pool, const hc_quartic *pair, int side) {
    const int A1 = hc_bits_of(&pair->p) - hc_bits_of(&pair->q); /* 2^(A1-1) < p/q < 2^(A1+1) */
    const int A2_B = A1 + hc_bits_of(&pair->s) - hc_bits_of(&pair->t); /* p s/(q t) < 2^(A2_B+2) */
    const int root = A1 + 1 > 0 ? (A1 + 2) / 2 : (A1 + 1) / 2, third = A2_B + 2 > 0 ? (A2_B + 4) / 3 : (A2_B + 2) / 3;
    if (side > 0) return hc_between_poles(pool, pair, 1, root > third ? root : third) > 0; /* B² > A1, B³ > A2 B */
    if (pair->oblate) return hc_between_poles(pool, pair, -1, 2 * A1 - 2) < 0;            /* A2 < 2^j < A1² */
    return hc_between_poles(pool, pair, -1, root) > 0;                                     /* A2² > A1 */
}

/* The sign of U + V √D for U = 2u + v k1, V = side v, D = k1² + 4 n: of u + v μ at a root μ of μ² = k1 μ + n, n > 0. */
static int hc_sign_with_root(hc_pool pool, const hc_quartic *pair, const hc_integer *n, hc_integer u, hc_integer v, int side) {
    const hc_integer twice_u = hc_multiple(&pool, 2, &u), v_k1 = hc_product(&pool, &v, &pair->k1);
    const hc_integer U = hc_sum(&pool, &twice_u, &v_k1, 1);
    const int V_sign = side * v.sign;
    if (U.sign * V_sign >= 0) return U.sign ? U.sign : V_sign;
    {
        const hc_integer U_U = hc_product(&pool, &U, &U), v_v = hc_product(&pool, &v, &v);
        const hc_integer k1_k1 = hc_product(&pool, &pair->k1, &pair->k1), n_4 = hc_multiple(&pool, 4, n);
        const hc_integer D = hc_sum(&pool, &k1_k1, &n_4, 1), v_v_D = hc_product(&pool, &v_v, &D);
        const hc_integer difference = hc_sum(&pool, &U_U, &v_v_D, -1);
        return U.sign * difference.sign;
    }
}

/* The sign of the i-th coefficient of F about a pole: about B or -A2 (side 1 or -1) with μ = k2 λ, or about -p/q (side 0)
   with μ = q λ. As f4 = q k2, k2³ F = q μ⁴ + f3 μ³ + k2 f2 μ² + ..., and likewise q³ F; Horner's values are u + v μ. */
static int hc_coefficient_sign(hc_pool pool, const hc_quartic *pair, int i, int side) {
    static const int binomials[4][5] = {{1, 1, 1, 1, 1}, {0, 1, 2, 3, 4}, {0, 0, 1, 3, 6}, {0, 0, 0, 1, 4}};
    const hc_integer f[4] = {pair->minus_f0, pair->f1, pair->f2, pair->f3};
    const hc_integer *const scale = side ? &pair->k2 : &pair->q, *const first = side ? &pair->q : &pair->k2;
    const hc_integer n = hc_product(&pool, &pair->k0, &pair->k2);
    hc_limb *const start = pool.next;
    hc_integer u = hc_multiple(&pool, (hc_limb)binomials[i][4], first), v = hc_taken(&pool, 0), power = hc_taken(&pool, 1);
    int j;
    power.sign = power.length = 1;
    power.limbs[0] = 1;
    for (j = 3; j >= i; j--) {
        const hc_integer term = hc_product(&pool, f + j, &power);
        hc_integer added = hc_multiple(&pool, (hc_limb)binomials[i][j], &term), next_u, next_v, next_power;
        if (j == 0) added.sign = -added.sign;
        if (side) { /* (u + v μ) μ = v n + (u + v k1) μ */
            const hc_integer v_n = hc_product(&pool, &v, &n), v_k1 = hc_product(&pool, &v, &pair->k1);
            next_u = hc_sum(&pool, &v_n, &added, 1);
            next_v = hc_sum(&pool, &u, &v_k1, 1);
        } else { /* μ = -p */
            const hc_integer u_p = hc_product(&pool, &u, &pair->p);
            next_u = hc_sum(&pool, &added, &u_p, -1);
            next_v = hc_taken(&pool, 0);
        }
        next_power = hc_product(&pool, &power, scale);
        u = next_u, v = next_v, power = next_power;
        pool.next = start;
        hc_keep(&pool, &u);
        hc_keep(&pool, &v);
        hc_keep(&pool, &power);
    }
    return side ? hc_sign_with_root(pool, pair, &n, u, v, side) : u.sign;
}

/* F has a multiple root. Clear is then only what has a pole for a double root, with F > 0 on its inner side. */
static int hc_clear_at_double_pole(hc_pool pool, const hc_quartic *pair, int side) {
    const int pole = side < 0 && pair->oblate ? 0 : side;
    return hc_coefficient_sign(pool, pair, 0, pole) == 0 && hc_coefficient_sign(pool, pair, 1, pole) == 0 &&
           hc_coefficient_sign(pool, pair, 2, pole) > 0;
}

/* Whether two of three roots of one sign lie beyond the pole of that side: by Descartes' rule, exact for real roots. */
static int hc_roots_beyond_pole(hc_pool pool, const hc_quartic *pair, int side) {
    const int pole = side < 0 && pair->oblate ? 0 : side;
    int i, changes = 0, before = 1; /* f4 > 0 */
    for (i = 3; i >= 0; i--) {
        const int found = hc_coefficient_sign(pool, pair, i, pole), sign = side < 0 && i % 2 ? -found : found;
        if (sign && sign != before) changes++, before = sign;
    }
    return changes > 1;
}

/* The position of a valid row of ten: kernel/tilted_integers.py of hypcheck says why. */
static int hc_exact_tilted_position(const double row[10]) {
    hc_limb limbs[HC_TILTED_LIMBS];
    hc_pool pool;
    hc_quartic pair;
    int delta, changes = 0, before = -1, i, side;
    if (hc_is_upright(row)) return hc_exact_position(row);
    pool.next = limbs;
    pair = hc_quartic_of(&pool, row);
    {
        const hc_integer f[5] = {pair.minus_f0, pair.f1, pair.f2, pair.f3, pair.f4};
        delta = hc_cut_discriminant_sign(pool, f);
        if (delta == 0) delta = hc_discriminant_sign(pool, f, 0);
        for (i = 1; i < 5; i++)
            if (f[i].sign && f[i].sign != before) changes++, before = f[i].sign;
    }
    if (delta < 0) return 0;
    if (delta == 0) return hc_clear_at_double_pole(pool, &pair, 1) - hc_clear_at_double_pole(pool, &pair, -1);
    side = changes == 3 ? 1 : -1;
    if (hc_product_too_small(pool, &pair, side)) return side;
    return hc_roots_beyond_pole(pool, &pair, side) ? 0 : side;
}
