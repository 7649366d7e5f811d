/* ---- hyperboloids that end: exact integers beside an end, upright ---- */

#define HC_END_BITS 256 /* of a length in its unit, at most */
#define HC_END_LIMBS (40960 / HC_LIMB_BITS + 64) /* the numbers below have 35,700 bits together */

/* At a height w the circle has r² = alpha² (1 + w²/gamma²), the spheroid's disc s² = b² (1 - (w - z)²/d²), and R = x² + y².
   `misses`: the circle misses the closed disc, Q = r² - s² + R > 0 and Q² > 4 R r². `reached` is the sign of s², `off` that
   of R - r². All are multiplied by gamma² d². */
typedef struct {
    int known, misses, reached, off;
} hc_end;

static hc_integer hc_length(hc_pool *pool, hc_parts parts, int unit) {
    hc_integer number = hc_taken(pool, HC_END_BITS / HC_LIMB_BITS + 2);
    hc_in_units(&number, parts, unit);
    return number;
}

static int hc_spread(const hc_parts *parts, int count, int *unit) {
    int most = -4096, k;
    *unit = 4096;
    for (k = 0; k < count; k++) {
        *unit = hc_least(*unit, parts[k].exponent);
        if (parts[k].sign && parts[k].exponent > most) most = parts[k].exponent;
    }
    return most + 53 - *unit;
}

static hc_end hc_exact_end(const double row[13], double w) {
    const hc_parts radial[4] = {hc_parts_of(row[0]), hc_parts_of(row[2]), hc_parts_of(row[4]), hc_parts_of(row[5])};
    const hc_parts axial[4] = {hc_parts_of(row[1]), hc_parts_of(row[3]), hc_parts_of(row[6]), hc_parts_of(w)};
    hc_limb limbs[HC_END_LIMBS];
    hc_pool pool;
    hc_end end = {0, 0, 0, 0};
    int across, along;
    pool.next = limbs;
    if (hc_spread(radial, 4, &across) > HC_END_BITS || hc_spread(axial, 4, &along) > HC_END_BITS) return end;
    {
        const hc_integer a = hc_length(&pool, radial[0], across), b = hc_length(&pool, radial[1], across);
        const hc_integer x = hc_length(&pool, radial[2], across), y = hc_length(&pool, radial[3], across);
        const hc_integer g = hc_length(&pool, axial[0], along), d = hc_length(&pool, axial[1], along);
        const hc_integer z = hc_length(&pool, axial[2], along), h = hc_length(&pool, axial[3], along);
        const hc_integer t = hc_sum(&pool, &h, &z, -1), t2 = hc_product(&pool, &t, &t), h2 = hc_product(&pool, &h, &h);
        const hc_integer a2 = hc_product(&pool, &a, &a), b2 = hc_product(&pool, &b, &b);
        const hc_integer x2 = hc_product(&pool, &x, &x), y2 = hc_product(&pool, &y, &y);
        const hc_integer g2 = hc_product(&pool, &g, &g), d2 = hc_product(&pool, &d, &d);
        const hc_integer up = hc_sum(&pool, &g2, &h2, 1), room = hc_sum(&pool, &d2, &t2, -1), R = hc_sum(&pool, &x2, &y2, 1);
        const hc_integer R_g2 = hc_product(&pool, &R, &g2), a2_up = hc_product(&pool, &a2, &up), off = hc_sum(&pool, &R_g2, &a2_up, -1);
        const hc_integer wide = hc_sum(&pool, &R_g2, &a2_up, 1), wide_d2 = hc_product(&pool, &wide, &d2);
        const hc_integer b2_g2 = hc_product(&pool, &b2, &g2), s = hc_product(&pool, &b2_g2, &room);
        const hc_integer Q = hc_sum(&pool, &wide_d2, &s, -1), Q2 = hc_product(&pool, &Q, &Q);
        const hc_integer both = hc_product(&pool, &R_g2, &a2_up), d4 = hc_product(&pool, &d2, &d2);
        const hc_integer product = hc_product(&pool, &both, &d4), four = hc_multiple(&pool, 4, &product);
        const hc_integer F = hc_sum(&pool, &Q2, &four, -1);
        end.known = 1;
        end.misses = Q.sign > 0 && F.sign > 0;
        end.reached = room.sign;
        end.off = off.sign;
    }
    return end;
}
