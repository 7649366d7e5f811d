/* ---- exact integers: the last stage ---- */

#if defined(__SIZEOF_INT128__) && !defined(HYPCHECK_SMALL_LIMBS)
typedef uint64_t hc_limb;
__extension__ typedef unsigned __int128 hc_wide;
#define HC_LIMB_BITS 64
#else
typedef uint32_t hc_limb;
typedef uint64_t hc_wide;
#define HC_LIMB_BITS 32
#endif

/* sign is -1, 0 or 1; the size is limbs[0] + limbs[1] 2^HC_LIMB_BITS + ..., limbs[length - 1] being no zero. */
typedef struct {
    int sign;
    int length;
    hc_limb *limbs;
} hc_integer;

/* Room for a number of so many bits, and for the limb by which the limbs of two factors exceed those of the product. */
#define HC_INTEGER(name, bits)                                          \
    hc_limb name##_limbs[((bits) + HC_LIMB_BITS - 1) / HC_LIMB_BITS + 1]; \
    hc_integer name = {0, 0, name##_limbs}

static int hc_compare_sizes(const hc_integer *left, const hc_integer *right) {
    int i;
    if (left->length != right->length) return left->length < right->length ? -1 : 1;
    for (i = left->length - 1; i >= 0; i--)
        if (left->limbs[i] != right->limbs[i]) return left->limbs[i] < right->limbs[i] ? -1 : 1;
    return 0;
}

static void hc_add_sizes(hc_integer *sum, const hc_integer *longer, const hc_integer *shorter) {
    hc_wide carry = 0;
    int i;
    for (i = 0; i < longer->length; i++) {
        carry += longer->limbs[i];
        if (i < shorter->length) carry += shorter->limbs[i];
        sum->limbs[i] = (hc_limb)carry;
        carry >>= HC_LIMB_BITS;
    }
    if (carry) sum->limbs[i++] = (hc_limb)carry;
    sum->length = i;
}

static void hc_subtract_sizes(hc_integer *difference, const hc_integer *larger, const hc_integer *smaller) {
    hc_limb borrow = 0;
    int i, length = 0;
    for (i = 0; i < larger->length; i++) {
        const hc_limb from = larger->limbs[i], taken = i < smaller->length ? smaller->limbs[i] : 0;
        const hc_limb rest = from - taken, left = rest - borrow;
        borrow = (hc_limb)((from < taken) | (rest < borrow));
        difference->limbs[i] = left;
        if (left) length = i + 1;
    }
    difference->length = length;
}

/* sum = left + sign right */
static void hc_combine(hc_integer *sum, const hc_integer *left, const hc_integer *right, int sign) {
    const int right_sign = sign * right->sign;
    if (left->sign * right_sign >= 0) {
        const int right_is_longer = left->length < right->length;
        hc_add_sizes(sum, right_is_longer ? right : left, right_is_longer ? left : right);
        sum->sign = left->sign ? left->sign : right_sign;
    } else {
        const int order = hc_compare_sizes(left, right);
        hc_subtract_sizes(sum, order < 0 ? right : left, order < 0 ? left : right);
        sum->sign = order < 0 ? right_sign : order > 0 ? left->sign : 0;
    }
}

static void hc_add(hc_integer *sum, const hc_integer *left, const hc_integer *right) {
    hc_combine(sum, left, right, 1);
}

static void hc_subtract(hc_integer *difference, const hc_integer *left, const hc_integer *right) {
    hc_combine(difference, left, right, -1);
}

/* to += factor from, or to = factor from for the first one; returns the limb behind the last. */
static hc_limb hc_add_row(hc_limb *to, const hc_limb *from, int length, hc_limb factor, int first) {
    hc_wide carry = 0;
    int i;
    if (first) {
        for (i = 0; i < length; i++) {
            carry += (hc_wide)from[i] * factor;
            to[i] = (hc_limb)carry;
            carry >>= HC_LIMB_BITS;
        }
    } else {
        for (i = 0; i < length; i++) {
            carry += (hc_wide)from[i] * factor + to[i];
            to[i] = (hc_limb)carry;
            carry >>= HC_LIMB_BITS;
        }
    }
    return (hc_limb)carry;
}

static void hc_multiply(hc_integer *product, const hc_integer *left, const hc_integer *right) {
    const hc_integer *const longer = left->length < right->length ? right : left;
    const hc_integer *const shorter = left->length < right->length ? left : right;
    hc_limb *const limbs = product->limbs;
    const int length = longer->length;
    int j;
    product->sign = left->sign * right->sign;
    product->length = 0;
    if (product->sign == 0) return;
    for (j = 0; j < shorter->length; j++)
        limbs[length + j] = hc_add_row(limbs + j, longer->limbs, length, shorter->limbs[j], j == 0);
    product->length = length + shorter->length;
    if (limbs[product->length - 1] == 0) product->length--;
}

/* product = factor number, 0 < factor */
static void hc_scale(hc_integer *product, hc_limb factor, const hc_integer *number) {
    hc_wide carry = 0;
    int i;
    for (i = 0; i < number->length; i++) {
        carry += (hc_wide)number->limbs[i] * factor;
        product->limbs[i] = (hc_limb)carry;
        carry >>= HC_LIMB_BITS;
    }
    if (carry) product->limbs[i++] = (hc_limb)carry;
    product->length = i;
    product->sign = number->sign;
}

/* A finite double is sign mantissa 2^exponent, the mantissa odd, or 0 with an exponent above all others, so that it does
   not choose the unit: any exponent would give right answers, a lower one longer integers. */
typedef struct {
    int sign;
    int exponent;
    uint64_t mantissa;
} hc_parts;

static hc_parts hc_parts_of(double value) {
    hc_parts parts;
    uint64_t bits;
    int biased;
    memcpy(&bits, &value, sizeof bits);
    biased = (int)(bits >> 52 & 0x7ff);
    parts.mantissa = (bits & 0xfffffffffffffu) | (biased ? (uint64_t)1 << 52 : 0);
    parts.exponent = (biased ? biased : 1) - 1075;
    parts.sign = parts.mantissa == 0 ? 0 : bits >> 63 ? -1 : 1;
    if (parts.mantissa == 0) parts.exponent = 2048;
    if (parts.mantissa) {
        const int zeros = hc_lowest_bit(parts.mantissa);
        parts.mantissa >>= zeros;
        parts.exponent += zeros;
    }
    return parts;
}

/* number = the parts in units of 2^unit; unit is at most their exponent, unless they are 0 */
static void hc_in_units(hc_integer *number, hc_parts parts, int unit) {
    uint64_t rest;
    int i = 0, shift;
    number->sign = parts.sign;
    number->length = 0;
    if (parts.sign == 0) return;
    for (shift = parts.exponent - unit; shift >= HC_LIMB_BITS; shift -= HC_LIMB_BITS) number->limbs[i++] = 0;
    number->limbs[i++] = (hc_limb)(parts.mantissa << shift);
    rest = shift ? parts.mantissa >> (HC_LIMB_BITS - shift) : parts.mantissa >> HC_LIMB_BITS / 2 >> HC_LIMB_BITS / 2;
    for (; rest; rest = rest >> HC_LIMB_BITS / 2 >> HC_LIMB_BITS / 2) number->limbs[i++] = (hc_limb)rest;
    number->length = i;
}

static int hc_least(int left, int right) { return left < right ? left : right; }

/* The position of a valid row, by the rule for all regimes (kernel/integers.py of hypcheck, docs/kernel.md). */
static int hc_position_by_integers(const double row[7]) {
    const hc_parts alpha_parts = hc_parts_of(row[0]), gamma_parts = hc_parts_of(row[1]), b_parts = hc_parts_of(row[2]),
                   d_parts = hc_parts_of(row[3]), x_parts = hc_parts_of(row[4]), y_parts = hc_parts_of(row[5]),
                   z_parts = hc_parts_of(row[6]);
    const int radial_unit = hc_least(hc_least(alpha_parts.exponent, b_parts.exponent),
                                     hc_least(x_parts.exponent, y_parts.exponent));
    const int axial_unit = hc_least(hc_least(gamma_parts.exponent, d_parts.exponent), z_parts.exponent);
    /* printed from the program "integers", the bits counted from it */
    @INTEGER_INPUTS@
    hc_in_units(&alpha, alpha_parts, radial_unit);
    hc_in_units(&b, b_parts, radial_unit);
    hc_in_units(&x, x_parts, radial_unit);
    hc_in_units(&y, y_parts, radial_unit);
    hc_in_units(&gamma, gamma_parts, axial_unit);
    hc_in_units(&d, d_parts, axial_unit);
    hc_in_units(&z, z_parts, axial_unit);
    {
        @INTEGERS@
        /* A sign that is 0 decides nothing here. Where delta > 0, n2 and n1 are not 0 beside n1 > 0 and n2 < 0: with c0 < 0,
           c1 = 0 makes 4 c2³ + 27 c0 of the sign of delta, negative for c2 < 0, and c2 = 0 makes it -4 c1³ - 27 c0². And no
           slope is 0 on the side of the inflection that is asked for: there it would be the local maximum of g, which is
           positive between two of three roots, and g(B) and g(-A) are not. At the inflection itself the slope is < 0. */
        if (delta.sign > 0 && n2.sign < 0 && n1.sign > 0) { /* three positive roots: are they all beyond B? */
            @INTEGERS_AT_B@
            return offset_at_B.sign < 0 && slope_at_B.sign > 0 ? 0 : 1;
        }
        if (delta.sign > 0) { /* two negative roots: do they lie above -A? */
            @INTEGERS_AT_A@
            return offset_at_A.sign > 0 && slope_at_A.sign > 0 ? -1 : 0;
        }
        if (delta.sign == 0 && z.sign == 0) { /* the ring: B is a double root, and the simple one lies below it */
            @INTEGERS_OF_RING@
            return slope_at_B.sign == 0 && ring_excess.sign > 0 ? 1 : 0;
        }
    }
    /* end of the program "integers" */
    return 0;
}

static int hc_valid(const double row[7]) {
    int i;
    for (i = 0; i < 7; i++) {
        uint64_t bits;
        memcpy(&bits, row + i, sizeof bits);
        if ((bits >> 52 & 0x7ff) == 0x7ff) return 0;          /* infinite or NaN */
        if (i < 4 && (bits >> 63 || bits == 0)) return 0; /* a size that is negative, -0.0 or 0 */
    }
    return 1;
}
