
/* ---- fixed point: the rule in 128 bits, before the exact integers ---- */

/* What is cut at most, in units (programs/fixed.py of hypcheck): of n2 and n1, of offsets and slopes at the poles, and of delta
   and `middle` for each 2^grown. */
@FIXED_ERRORS@
#define HC_MOST_GROWN 100

/* A number in two's complement, of units that are told beside it. */
typedef struct {
    uint64_t low, high;
} hc_fixed;

/* The 128 bits of a product. */
static inline hc_fixed hc_fixed_full(uint64_t left, uint64_t right) {
    hc_fixed product;
#if HC_LIMB_BITS == 64
    const hc_wide wide = (hc_wide)left * right;
    product.low = (uint64_t)wide;
    product.high = (uint64_t)(wide >> 64);
#else
    const uint64_t half = 0xffffffffu, low = (left & half) * (right & half);
    const uint64_t mixed = (left >> 32) * (right & half) + (low >> 32);
    const uint64_t other = (left & half) * (right >> 32) + (mixed & half);
    product.low = other << 32 | (low & half);
    product.high = (left >> 32) * (right >> 32) + (mixed >> 32) + (other >> 32);
#endif
    return product;
}

/* The same of a number in two's complement and one >= 0. */
static inline hc_fixed hc_fixed_full_signed(uint64_t left, uint64_t right) {
    hc_fixed product = hc_fixed_full(left, right);
    product.high -= right & (0 - (left >> 63));
    return product;
}

static inline hc_fixed hc_fixed_plus(hc_fixed left, hc_fixed right) {
    hc_fixed sum;
    sum.low = left.low + right.low;
    sum.high = left.high + right.high + (sum.low < left.low);
    return sum;
}

static inline hc_fixed hc_fixed_minus(hc_fixed left, hc_fixed right) {
    hc_fixed difference;
    difference.low = left.low - right.low;
    difference.high = left.high - right.high - (left.low < right.low);
    return difference;
}

/* All bits of a number < 0, none of another. */
static inline uint64_t hc_fixed_negative(hc_fixed number) { return 0 - (number.high >> 63); }

/* The highest 128 of the 256 bits of a product of numbers >= 0, less than 3 units too low. */
static inline hc_fixed hc_fixed_product(hc_fixed left, hc_fixed right) {
    const uint64_t mixed = hc_fixed_full(left.high, right.low).high, other = hc_fixed_full(left.low, right.high).high;
    hc_fixed product = hc_fixed_full(left.high, right.high);
    product.low += mixed;
    product.high += product.low < mixed;
    product.low += other;
    product.high += product.low < other;
    return product;
}

/* The same where the first factor, or both, may be < 0: 2^128 more of it than is meant gave so much of the other too much. */
static inline hc_fixed hc_fixed_signed_product(hc_fixed left, hc_fixed right) {
    const uint64_t mask = hc_fixed_negative(left);
    hc_fixed excess;
    excess.low = right.low & mask;
    excess.high = right.high & mask;
    return hc_fixed_minus(hc_fixed_product(left, right), excess);
}

static inline hc_fixed hc_fixed_both_signed_product(hc_fixed left, hc_fixed right) {
    const uint64_t mask = hc_fixed_negative(right);
    hc_fixed excess;
    excess.low = left.low & mask;
    excess.high = left.high & mask;
    return hc_fixed_minus(hc_fixed_signed_product(left, right), excess);
}

static inline hc_fixed hc_fixed_square(hc_fixed number) {
    const uint64_t mask = hc_fixed_negative(number), low = (number.low ^ mask) - mask;
    const uint64_t high = (number.high ^ mask) + (mask & (low == 0)), mixed = hc_fixed_full(high, low).high;
    hc_fixed square = hc_fixed_full(high, high);
    square.high += mixed >> 63;
    square.low += mixed << 1;
    square.high += square.low < mixed << 1;
    return square;
}

/* number 2^by, by being 0 .. 127 */
static inline hc_fixed hc_fixed_up(hc_fixed number, int by) {
    const int rest = by & 63;
    const uint64_t low = number.low << rest, high = number.high << rest | number.low >> 1 >> (63 - rest);
    hc_fixed moved;
    moved.low = by & 64 ? 0 : low;
    moved.high = by & 64 ? low : high;
    return moved;
}

/* number / 2^by rounded down; beyond 127, as for 127, 0 or -1 */
static inline hc_fixed hc_fixed_down(hc_fixed number, int by) {
    const uint64_t mask = hc_fixed_negative(number);
    const int most = by < 127 ? by : 127, rest = most & 63;
    const uint64_t low = number.low >> rest | number.high << 1 << (63 - rest), high = number.high >> rest | mask << 1 << (63 - rest);
    hc_fixed moved;
    moved.low = most & 64 ? high : low;
    moved.high = most & 64 ? mask : high;
    return moved;
}

/* 2, 3, 4 or 9 times the number */
static inline hc_fixed hc_fixed_times(int factor, hc_fixed number) {
    const hc_fixed most = hc_fixed_up(number, factor == 9 ? 3 : factor == 4 ? 2 : 1);
    return factor & 1 ? hc_fixed_plus(most, number) : most;
}

/* The bits of the size of a number, 1 for 0 and -1. */
static inline int hc_fixed_bits(hc_fixed number) {
    const uint64_t mask = hc_fixed_negative(number), high = number.high ^ mask, low = number.low ^ mask;
    return high ? 65 + hc_highest_bit(high) : 1 + hc_highest_bit(low | 1);
}

/* The sign of a number that is farther from 0 than `error` 2^grown, else 0. */
static inline int hc_fixed_sign(hc_fixed number, uint64_t error, int grown) {
    const uint64_t mask = hc_fixed_negative(number), high = number.high ^ mask, low = number.low ^ mask;
    hc_fixed limit = {0, 0};
    limit.low = error;
    limit = hc_fixed_up(limit, grown);
    return high > limit.high || (high == limit.high && low > limit.low) ? (mask ? -1 : 1) : 0;
}

/* A finite double as mantissa 2^(exponent - 1075), the mantissa having 53 bits, or as 0 with an exponent below all others. */
static inline hc_parts hc_fixed_parts_of(double value) {
    const uint64_t leading = (uint64_t)1 << 52;
    hc_parts parts;
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    parts.sign = 1;
    parts.exponent = (int)(bits >> 52 & 0x7ff);
    parts.mantissa = bits & (leading - 1);
    if (parts.exponent) {
        parts.mantissa |= leading;
    } else if (parts.mantissa) {
        const int zeros = 52 - hc_highest_bit(parts.mantissa);
        parts.mantissa <<= zeros;
        parts.exponent = 1 - zeros;
    } else {
        parts.exponent = -4096;
    }
    return parts;
}

/* The square of the mantissa, 1/4 at least and less than 1, in units of 2^-126. */
static inline hc_fixed hc_fixed_whole(hc_parts parts) { return hc_fixed_full(parts.mantissa << 10, parts.mantissa << 10); }

/* What the rule is made of, in the units of the program "fixed-terms" (programs/fixed.py of hypcheck). What has a factor b²
   was divided by 2^by_q besides, and what has d² by 2^by_t; n2 is so 2^small times as large. */
typedef struct {
    hc_fixed p, q, s, t, S, R, whole_q, whole_t, N, n2, n1, ps;
    int by_q, by_t, small;
    int top_N, top_ps; /* N is below 2^top_N, ps below 2^top_ps */
} hc_fixed_terms;

static hc_fixed_terms hc_fixed_terms_of(const double row[7]) {
    const hc_parts alpha = hc_fixed_parts_of(row[0]), gamma = hc_fixed_parts_of(row[1]), b = hc_fixed_parts_of(row[2]),
                   d = hc_fixed_parts_of(row[3]), x = hc_fixed_parts_of(row[4]), y = hc_fixed_parts_of(row[5]),
                   z = hc_fixed_parts_of(row[6]);
    const int radial = HC_MAX_OF(HC_MAX_OF(alpha.exponent, b.exponent), HC_MAX_OF(x.exponent, y.exponent));
    const int axial = HC_MAX_OF(HC_MAX_OF(gamma.exponent, d.exponent), z.exponent);
    const int small_p = 2 * (radial - alpha.exponent), small_q = 2 * (radial - b.exponent);
    const int small_s = 2 * (axial - gamma.exponent), small_t = 2 * (axial - d.exponent);
    const int small = HC_MIN_OF(small_q, small_t), by_q = small_q - small, by_t = small_t - small;
    const hc_fixed whole_p = hc_fixed_whole(alpha), whole_q = hc_fixed_whole(b), whole_s = hc_fixed_whole(gamma),
                   whole_t = hc_fixed_whole(d);
    const hc_fixed p = hc_fixed_down(whole_p, small_p), q = hc_fixed_down(whole_q, small_q),
                   s = hc_fixed_down(whole_s, small_s), t = hc_fixed_down(whole_t, small_t),
                   xx = hc_fixed_down(hc_fixed_whole(x), 2 * (radial - x.exponent)),
                   yy = hc_fixed_down(hc_fixed_whole(y), 2 * (radial - y.exponent)),
                   S = hc_fixed_down(hc_fixed_whole(z), 2 * (axial - z.exponent));
    hc_fixed_terms terms;
    /* printed from the program "fixed-terms" */
    @FIXED_TERMS@
    /* end of the program "fixed-terms" */
    terms.p = p, terms.q = q, terms.s = s, terms.t = t, terms.S = S, terms.R = R;
    terms.whole_q = whole_q, terms.whole_t = whole_t;
    terms.N = N, terms.n1 = n1, terms.ps = ps;
    terms.n2 = hc_fixed_minus(hc_fixed_down(radial_2, by_t), hc_fixed_down(axial_2, by_q));
    terms.by_q = by_q, terms.by_t = by_t, terms.small = small;
    terms.top_N = -small_q - small_t, terms.top_ps = -small_p - small_s;
    return terms;
}

/* Numbers of the program "fixed-discriminant", whose errors are multiples of 2^grown units, of roots divided by 2^k. */
typedef struct {
    hc_fixed delta, middle, h1, h2, N, n2;
    int grown, k;
} hc_fixed_cubic;

static hc_fixed_cubic hc_fixed_cubic_of(const hc_fixed_terms *terms) {
    const int bits_2 = hc_fixed_bits(terms->n2), bits_1 = hc_fixed_bits(terms->n1);
    const int top_2 = bits_2 - 124 - terms->small, top_1 = bits_1 - 124, top_0 = terms->top_ps, top_3 = terms->top_N;
    /* 2^k is about |n1 / n2|, but not where one of them has vanished: then the others tell the size of the roots. */
    const int least = HC_MAX_OF(top_1 - top_2, (top_0 - top_2) / 2), most = HC_MAX_OF((top_1 - top_3) / 2, (top_0 - top_3) / 3);
    const int k = HC_MIN_OF(least, most);
    const int top = HC_MAX_OF(HC_MAX_OF(top_3 + 3 * k, top_2 + 2 * k), HC_MAX_OF(top_1 + k, top_0));
    const int down_3 = top - top_3 - 3 * k, down_2 = top - top_2 - 2 * k, down_1 = top - top_1 - k, down_0 = top - top_0;
    const int up_2 = 126 - bits_2, up_1 = 126 - bits_1;
    const hc_fixed N = hc_fixed_down(hc_fixed_up(terms->N, 1), down_3), ps = hc_fixed_down(hc_fixed_up(terms->ps, 1), down_0),
                   n2 = hc_fixed_down(hc_fixed_up(terms->n2, up_2), down_2 + 1),
                   n1 = hc_fixed_down(hc_fixed_up(terms->n1, up_1), down_1 + 1);
    hc_fixed_cubic cubic;
    /* printed from the program "fixed-discriminant" */
    @FIXED_DISCRIMINANT@
    /* end of the program "fixed-discriminant" */
    cubic.delta = delta;
    cubic.middle = middle;
    cubic.h1 = h1, cubic.h2 = h2, cubic.N = N, cubic.n2 = n2, cubic.k = k;
    cubic.grown = HC_MAX_OF(0, HC_MAX_OF(up_2 - down_2, up_1 - down_1) - 1);
    return cubic;
}

/* The signs of 3B + c2 and of g'(B), 0 where they are not certain. */
static void hc_fixed_at_B(const hc_fixed_terms *terms, int *offset, int *slope) {
    const hc_fixed p = terms->p, s = terms->s, t = terms->t, S = terms->S, R = terms->R, n2 = terms->n2;
    const hc_fixed whole_q = terms->whole_q, whole_t = terms->whole_t;
    /* printed from the program "fixed-poles" */
    @FIXED_AT_B@
    /* end of the program "fixed-poles" */
    *offset = hc_fixed_sign(offset_at_B, HC_fixed_pole, 0);
    *slope = hc_fixed_sign(slope_at_B, HC_fixed_pole, 0);
}

/* The signs of 3A - c2 and of g'(-A). */
static void hc_fixed_at_A(const hc_fixed_terms *terms, int *offset, int *slope) {
    const hc_fixed p = terms->p, q = terms->q, s = terms->s, S = terms->S, R = terms->R, n2 = terms->n2;
    const hc_fixed whole_q = terms->whole_q, whole_t = terms->whole_t;
    /* printed from the program "fixed-poles" */
    @FIXED_AT_A@
    /* end of the program "fixed-poles" */
    *offset = hc_fixed_sign(offset_at_A, HC_fixed_pole, 0);
    *slope = hc_fixed_sign(slope_at_A, HC_fixed_pole, 0);
}

/* About the number, as good as a guess has to be; a small number, such as the product of two short lengths, exactly. */
static inline double hc_fixed_value(hc_fixed number) {
    const double low = 2.0 * (double)(int64_t)(number.low >> 1) + (double)(int)(number.low & 1);
    return (double)(int64_t)number.high * 18446744073709551616.0 + low;
}

/* About the double root that the cubic has if delta is 0, or 0 where there is no guess. */
static double hc_fixed_double_root(const hc_fixed_cubic *cubic) {
    const int most = 1000;
    const uint64_t bits = (uint64_t)(cubic->k + 1023) << 52;
    double power;
    if (cubic->k < -most || cubic->k > most || cubic->grown > HC_MOST_GROWN) return 0;
    memcpy(&power, &bits, sizeof power);
    if (hc_fixed_sign(cubic->h1, 64, cubic->grown) == 0) /* a triple one */
        return hc_fixed_value(cubic->n2) / (-3 * hc_fixed_value(cubic->N)) * power;
    return -0.5 * hc_fixed_value(cubic->h2) / hc_fixed_value(cubic->h1) * power;
}

/* The position of a valid row; 2 where the bounds do not tell: then `about` is about the double root, if it is one. */
static int hc_fixed_position(const double row[7], double *about) {
    const hc_fixed_terms terms = hc_fixed_terms_of(row);
    const hc_fixed_cubic cubic = hc_fixed_cubic_of(&terms);
    const int delta = cubic.grown > HC_MOST_GROWN ? 0 : hc_fixed_sign(cubic.delta, HC_fixed_delta, cubic.grown);
    const int c2 = hc_fixed_sign(terms.n2, HC_fixed_coefficient, 0), c1 = hc_fixed_sign(terms.n1, HC_fixed_coefficient, 0);
    int offset, slope;
    *about = delta ? 0 : hc_fixed_double_root(&cubic);
    if (delta < 0) return 0;
    if (c2 < 0 && c1 > 0) { /* where delta > 0, three positive roots */
        hc_fixed_at_B(&terms, &offset, &slope);
        if (delta > 0 && (offset > 0 || slope < 0)) return 1;
        if (offset < 0 && slope > 0) return 0; /* whatever delta is */
        /* g > 0 at its inflection, which lies between 0 and B: the ring, or nearly so */
        return offset > 0 && cubic.grown <= HC_MOST_GROWN && hc_fixed_sign(cubic.middle, HC_fixed_middle, cubic.grown) > 0 ? 1 : 2;
    }
    if (c2 > 0 || c1 < 0) { /* where delta > 0, two negative roots; they lie above -A if alpha >= b */
        if (delta > 0 && row[0] >= row[2]) return -1;
        hc_fixed_at_A(&terms, &offset, &slope);
        if (offset < 0 || slope < 0) return 0; /* whatever delta is: on the ring all roots are positive */
        return delta > 0 && offset > 0 && slope > 0 ? -1 : 2;
    }
    return 2;
}
