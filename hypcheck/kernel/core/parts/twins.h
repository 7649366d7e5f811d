/* ---- numbers of two doubles ---- */

/* high + low. Every operation below is right within 2^-100 of its result, a sum of the sizes of its operands, in each rounding
   mode, where products of halves neither overflow nor lose more than a negligible part (the sizes of hc_make_sections).

   A sum of two doubles, the larger first: their rounded sum minus the larger is a double in any mode that rounds to one of
   the two neighbours, and what is left is rounded by 2u of itself. A product: each factor is cut behind 26 bits, towards 0.
   In units where 1 <= a, b < 2 the parts are multiples of 2^-25 and 2^-52, and all but the last step below are exact: p
   within 2^-51 of ab, top·top - p a multiple of 2^-52 below 2^-22, the next two multiples of 2^-77 below 2^-24; the last
   product, of 27 bits twice, may lose one bit of 2^-104. Contraction into FMA changes no exact step. */
typedef struct {
    double high, low;
} hc_twin;

static hc_twin hc_twin_of(double value) {
    hc_twin made;
    made.high = value;
    made.low = 0;
    return made;
}

static hc_twin hc_two_sum(double one, double other) {
    const int less = hc_size(one) < hc_size(other);
    const double large = less ? other : one, small = less ? one : other, sum = large + small, kept = sum - large;
    hc_twin made;
    made.high = sum;
    made.low = small - kept;
    return made;
}

static double hc_top_half(double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    bits &= ~(uint64_t)0x7ffffff;
    memcpy(&value, &bits, sizeof bits);
    return value;
}

static hc_twin hc_two_product(double one, double other) {
    const double top = hc_top_half(one), rest = one - top, over = hc_top_half(other), under = other - over, p = one * other;
    double error = top * over - p;
    hc_twin made;
    error += top * under;
    error += rest * over;
    error += rest * under;
    made.high = p;
    made.low = error;
    return made;
}

static hc_twin hc_twin_sum(hc_twin one, hc_twin other) {
    const hc_twin high = hc_two_sum(one.high, other.high);
    return hc_two_sum(high.high, high.low + (one.low + other.low));
}

static hc_twin hc_twin_minus(hc_twin one) {
    one.high = -one.high;
    one.low = -one.low;
    return one;
}

static hc_twin hc_twin_difference(hc_twin one, hc_twin other) { return hc_twin_sum(one, hc_twin_minus(other)); }

static hc_twin hc_twin_product(hc_twin one, hc_twin other) {
    const hc_twin high = hc_two_product(one.high, other.high);
    return hc_two_sum(high.high, high.low + (one.high * other.low + one.low * other.high));
}

static hc_twin hc_twin_square(hc_twin value) { return hc_twin_product(value, value); }

static hc_twin hc_twin_quotient(hc_twin one, hc_twin other) {
    const double first = one.high / other.high;
    const hc_twin left = hc_twin_difference(one, hc_twin_product(other, hc_twin_of(first)));
    return hc_two_sum(first, left.high / other.high);
}

/* hc_fine_root is right within 2^-50, its error is halved and squared by one more step of Newton's method. */
static hc_twin hc_twin_root(hc_twin square) {
    const double root = hc_fine_root(square.high);
    const hc_twin left = hc_twin_difference(square, hc_two_product(root, root));
    return root > 0 ? hc_two_sum(root, left.high / (2 * root)) : hc_twin_of(0);
}
