
/* ---- exact tangencies: a double root that is proved in 256 bits ---- */

#define HC_TANGENCY_BITS 62 /* lengths in units of their lowest bit, for which all numbers here fit */
#define HC_TANGENCY_TURNS 4 /* of Newton's method */
#define HC_HAIR 1e-18       /* of b, or of gamma: a coordinate so short is looked at apart */

/* A whole number in two's complement, modulo 2^256. */
typedef struct {
    uint64_t words[4];
} hc_long;

static inline hc_long hc_long_product(hc_fixed left, hc_fixed right) {
    const hc_fixed low = hc_fixed_full(left.low, right.low), high = hc_fixed_full(left.high, right.high);
    const hc_fixed mixed = hc_fixed_full(left.low, right.high), other = hc_fixed_full(left.high, right.low);
    hc_long product;
    uint64_t carry;
    product.words[0] = low.low;
    product.words[1] = low.high + mixed.low;
    carry = product.words[1] < mixed.low;
    product.words[1] += other.low;
    carry += product.words[1] < other.low;
    product.words[2] = high.low + carry;
    product.words[3] = high.high + (product.words[2] < carry);
    product.words[2] += mixed.high;
    product.words[3] += product.words[2] < mixed.high;
    product.words[2] += other.high;
    product.words[3] += product.words[2] < other.high;
    return product;
}

/* left + right, or left - right */
static inline hc_long hc_long_sum(hc_long left, hc_long right, int minus) {
    const uint64_t mask = 0 - (uint64_t)minus;
    uint64_t carry = (uint64_t)minus;
    hc_long sum;
    int i;
    for (i = 0; i < 4; i++) {
        const uint64_t term = right.words[i] ^ mask, part = left.words[i] + term;
        sum.words[i] = part + carry;
        carry = (uint64_t)((part < term) | (sum.words[i] < carry));
    }
    return sum;
}

/* The product of a number of any sign and one >= 0 */
static inline hc_long hc_long_signed_product(hc_fixed left, hc_fixed right) {
    const uint64_t mask = hc_fixed_negative(left);
    hc_long product = hc_long_product(left, right), excess = {{0, 0, 0, 0}};
    excess.words[2] = right.low & mask;
    excess.words[3] = right.high & mask;
    return hc_long_sum(product, excess, 1);
}

static inline int hc_long_is_zero(hc_long number) {
    return (number.words[0] | number.words[1] | number.words[2] | number.words[3]) == 0;
}

static inline int hc_long_is_negative(hc_long number) { return (int)(number.words[3] >> 63); }

/* About the number: good for a guess. */
static inline double hc_long_value(hc_long number) {
    const hc_long none = {{0, 0, 0, 0}};
    const double unit = 18446744073709551616.0;
    const int negative = hc_long_is_negative(number);
    double value = 0;
    int i;
    if (negative) number = hc_long_sum(none, number, 1);
    for (i = 3; i >= 0; i--) value = value * unit + 2.0 * (double)(int64_t)(number.words[i] >> 1) + (double)(int)(number.words[i] & 1);
    return negative ? -value : value;
}

/* The whole number nearest to a value below 2^126 in size. */
static hc_fixed hc_fixed_nearest(double value) {
    const double size = value < 0 ? -value : value;
    hc_fixed number = {0, 0};
    if (size < 4503599627370496.0) { /* 2^52 */
        number.low = (uint64_t)(size + 0.5);
    } else {
        const hc_parts parts = hc_fixed_parts_of(size);
        number.low = parts.mantissa;
        number = hc_fixed_up(number, parts.exponent - 1075);
    }
    if (value < 0) {
        const hc_fixed none = {0, 0};
        number = hc_fixed_minus(none, number);
    }
    return number;
}

/* The lengths alpha, gamma, b, d, x, y, z in units of the lowest bits of their kind. Returns how many bits hold the longest;
   more than HC_TANGENCY_BITS, and no lengths, where it is too long. */
static int hc_short_lengths(const double row[7], uint64_t lengths[7]) {
    hc_parts parts[7];
    uint64_t all = 0;
    int i, unit[2] = {4096, 4096};
    for (i = 0; i < 7; i++) {
        parts[i] = hc_fixed_parts_of(row[i]);
        if (parts[i].mantissa) {
            int *const least = unit + (i == 1 || i == 3 || i == 6);
            *least = hc_least(*least, parts[i].exponent + hc_lowest_bit(parts[i].mantissa));
        }
    }
    for (i = 0; i < 7; i++) {
        const int up = parts[i].exponent - unit[i == 1 || i == 3 || i == 6];
        if (up > HC_TANGENCY_BITS - 53) return HC_TANGENCY_BITS + 1;
        lengths[i] = up >= 0 ? parts[i].mantissa << up : up > -64 ? parts[i].mantissa >> -up : 0;
        all |= lengths[i];
    }
    return 1 + hc_highest_bit(all);
}

#define HC_NAMED_LENGTHS(lengths)                                                                                                      \
    const uint64_t alpha = lengths[0], gamma = lengths[1], b = lengths[2], d = lengths[3], x = lengths[4], y = lengths[5];

/* 1 or -1 where the row touches from without or from within in a double root that is `about` this number, which is then
   proved: with D = b d and K = alpha gamma, N g is (D l - M)² (l - e²/D²) for whole numbers M and e of the same sign with

       M e = D K,  n2 = -(2 D M + e²),  n1 = M² + 2 K e

   (docs/kernel.md of hypcheck). 2 where it is not so. */
static int hc_touches_by(const uint64_t lengths[7], double about) {
    HC_NAMED_LENGTHS(lengths)
    const uint64_t z = lengths[6];
    /* printed from the program "tangency", what M and e do not change */
    @TANGENCY_BEFORE@
    /* end of the program "tangency" */
    const double d_ = hc_fixed_value(D), k_ = hc_fixed_value(K), size = inner ? -about : about, most = 4.2535295865117308e37; /* 2^125 */
    double m_ = size * d_, e_ = k_ / size;
    hc_fixed M, e;
    int turn;
    if (!(size > 0 && m_ < most && e_ < most)) return 2;
    M = hc_fixed_nearest(m_);
    e = hc_fixed_nearest(e_);
    for (turn = 0; turn < HC_TANGENCY_TURNS; turn++) { /* M and e are the sizes here */
        /* printed from the program "tangency", two equations */
        @TANGENCY_EQUATIONS@
        /* end of the program "tangency" */
        double r1_, half, det, dM, de;
        if (hc_long_is_zero(r1) && hc_long_is_zero(r2)) {
            /* printed from the program "tangency", the third, and where the root lies */
            @TANGENCY_LAST@
            /* end of the program "tangency" */
            if (!hc_long_is_zero(r3)) return 2;
            /* within: -A <= M/D; without: M/D <= B, and the simple root is not below it */
            if (inner) return hc_long_is_negative(room_within) ? 2 : -1;
            return hc_long_is_negative(beyond) || hc_long_is_negative(room_without) ? 2 : 1;
        }
        r1_ = hc_long_value(r1), half = 0.5 * hc_long_value(r2);
        m_ = inner ? -hc_fixed_value(M) : hc_fixed_value(M), e_ = inner ? -hc_fixed_value(e) : hc_fixed_value(e);
        det = e_ * e_ - m_ * d_;
        dM = (e_ * r1_ + m_ * half) / det;
        de = -(e_ * half + d_ * r1_) / det;
        if (inner) dM = -dM, de = -de;
        if (!(dM < most && dM > -most && de < most && de > -most)) return 2;
        {
            const hc_fixed by_M = hc_fixed_nearest(dM), by_e = hc_fixed_nearest(de);
            if ((by_M.low | by_M.high | by_e.low | by_e.high) == 0) return 2;
            M = hc_fixed_plus(M, by_M);
            e = hc_fixed_plus(e, by_e);
            if ((M.high | e.high) >> 62) return 2;
        }
    }
    return 2;
}

/* The same where lengths have 23 bits at most, and M and e 46: those are guessed right, and 128 bits hold everything. */
static int hc_touches_by_short(const uint64_t lengths[7], double about) {
    HC_NAMED_LENGTHS(lengths)
    const uint64_t z = lengths[6];
    /* printed from the program "tangency", for short lengths */
    @TANGENCY_SHORT_BEFORE@
    /* end of the program "tangency" */
    const double size = inner ? -about : about, m_ = size * (double)(int64_t)D, e_ = (double)(int64_t)K / size, most = 70368744177664.0; /* 2^46 */
    uint64_t M, e;
    if (!(size > 0 && m_ < most && e_ < most)) return 2;
    M = (uint64_t)(int64_t)(m_ + 0.5), e = (uint64_t)(int64_t)(e_ + 0.5);
    {
        /* printed from the program "tangency", the equations for short lengths */
        @TANGENCY_SHORT@
        /* end of the program "tangency" */
        if (r1.low | r1.high | r2.low | r2.high | r3.low | r3.high) return 2;
        if (inner) return hc_fixed_negative(room_within) ? 2 : -1;
        return hc_fixed_negative(beyond) || hc_fixed_negative(room_without) ? 2 : 1;
    }
}

/* The position of a row in the plane of the waist, z = 0, or 2. There g is B - l times -(l² - w l + A), w = P - 1 - A: contact
   where w² <= 4A, exterior where w > 0 and the lower root is below B, interior where w < 0 and the mean -w/2 is above -A. */
static int hc_position_in_plane(const uint64_t lengths[7]) {
    HC_NAMED_LENGTHS(lengths)
    /* printed from the program "waist", W */
    @WAIST_BEFORE@
    /* end of the program "waist" */
    const hc_fixed size = hc_fixed_negative(W) ? opposite : W;
    /* printed from the program "waist", the discriminant */
    @WAIST_EXCESS@
    /* end of the program "waist" */
    if (!hc_long_is_negative(excess)) return 0;
    {
        /* printed from the program "waist", where the roots lie */
        @WAIST_SIDES@
        /* end of the program "waist" */
        /* W = -2p, where R = q - p >= 0, is not here: A <= 1 then, so that w² = 4A² is not above 4A. */
        if (hc_fixed_negative(W)) return hc_fixed_negative(W_p_2) ? 0 : -1;
        return hc_long_is_negative(room) ? 2 : 1;
    }
}

/* The position of a row in the plane of the waist, or of one that touches, but for coordinates of a hair's breadth; else 2. Where
   x² + y² grows, a tangency from without becomes exterior, and one from within contact; where z² grows, contact and interior. A
   hair is too short to lead through contact to the other side (docs/kernel.md of hypcheck). */
static int hc_position_beside_tangency(const double row[7], double about) {
    double bare[7];
    uint64_t lengths[7];
    int i, bits, side, radial = 0, axial = 0;
    memcpy(bare, row, sizeof bare);
    for (i = 4; i < 7; i++) {
        const double size = row[i] < 0 ? -row[i] : row[i];
        if (size > 0 && size < HC_HAIR * row[i == 6 ? 1 : 2]) {
            bare[i] = 0;
            if (i == 6) axial = 1;
            else radial = 1;
        }
    }
    bits = radial && axial ? 64 : hc_short_lengths(bare, lengths);
    if (bits > HC_TANGENCY_BITS) return 2;
    side = radial || axial || lengths[6] ? 2 : hc_position_in_plane(lengths);
    if (side != 2) return side;
    side = bits <= 23 ? hc_touches_by_short(lengths, about) : hc_touches_by(lengths, about);
    if (side == 2) return 2;
    return (side > 0 ? radial : axial) ? side : 0;
}

/* The position of a valid row. */
static int hc_exact_position(const double row[7]) {
    double about;
    int position = hc_fixed_position(row, &about);
    if (position == 2) position = hc_position_beside_tangency(row, about);
    return position == 2 ? hc_position_by_integers(row) : position;
}
