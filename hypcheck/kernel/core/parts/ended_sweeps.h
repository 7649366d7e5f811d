/* ---- straight sweeps beside hyperboloids that end ---- */

#define HC_MOST_RECTANGLES 1024 /* that are looked at before a stretch is given up */
#define HC_RECTANGLES_KEPT 64
#define HC_AIMS 3
#define HC_SMALL 9.5367431640625e-07 /* 2^-20 */
#define HC_TIMES 60 /* halvings of the time before a contact, of which so many, one after the other, may tell nothing */
#define HC_MOST_UNKNOWN 12
#define HC_FINE_SLACK 2.8421709430404007e-14 /* 2^-45, of the sweep's slack: 2^-96 (1 + the sum in radii) */
#define HC_NEAR_CONTACT 8 /* errors of a form, within which numbers of two doubles are asked */
#define HC_SIMPLE_TIMES 1048576.0 /* 2^20: times that are asked exactly are whole numbers over this */

/* A sweep, and the sections of the spheroid larger by its slack, which holds the exact one at all times, and of the one
   smaller by it, which the exact one holds. `rise`, `off` and `aside` are what z, eta and xi0 change in a unit of time.

   `outer` and `inner` are the same by numbers of two doubles: from + t (to - from) is right within 2^-98 (|from| + |to|),
   which makes a slack of 2^-96 (1 + the sum in radii), and squares are multiplied by 1 + 4 slack and 1 - 4 slack. `between`
   are the sections of the spheroid as it is, for slopes. `wide` is |x| + |y| of both ends, `tall` |z| of both. */
typedef struct {
    hc_sweep sweep;
    hc_sections larger, smaller, between;
    hc_fine_sections outer, inner;
    hc_twin moved[3];
    double rise, off, aside, swift, reach, low, high, wide, tall;
    const double *row, *axis;
    int solid, wall, fine, clear[2]; /* `clear`: that there is no contact at the start, at the end */
} hc_ended_sweep;

/* Heights and times. */
typedef struct {
    double low, high, first, last;
} hc_rectangle;

/* phi about a height and a time, for one lambda: value + rise x + fall y + xx x² + 2 xy x y + yy y². */
typedef struct {
    double value, by_height, by_time, xx, xy, yy;
} hc_form;

static int hc_make_ended_sweep(hc_ended_sweep *made, const double row[16], const double *axis) {
    double shape[10] = {0};
    if (!hc_make_sweep(&made->sweep, row, axis)) return 0;
    hc_sweep_at(&made->sweep, 0, 1 + made->sweep.slack, shape);
    if (axis) memcpy(shape + 7, axis, 3 * sizeof *axis);
    else shape[9] = 1;
    shape[4] = shape[5] = shape[6] = 0;
    if (!hc_make_sections(&made->larger, shape)) return 0;
    hc_sweep_at(&made->sweep, 0, 1 - made->sweep.slack, shape);
    shape[4] = shape[5] = shape[6] = 0;
    if (!hc_make_sections(&made->smaller, shape)) return 0;
    hc_place_sections(&made->larger, made->sweep.change);
    made->rise = made->sweep.change[2];
    made->off = made->larger.eta;
    made->aside = made->larger.xi0;
    made->swift = made->larger.across;
    made->reach = hc_fine_root(made->larger.T) * (1 + HC_ENDED_ERROR);
    made->low = row[13];
    made->high = row[14];
    made->solid = row[15] != 0;
    made->wide = hc_size(row[4]) + hc_size(row[5]) + hc_size(row[7]) + hc_size(row[8]);
    made->tall = hc_size(row[6]) + hc_size(row[9]);
    made->wall = 1;
    made->row = row;
    made->axis = axis;
    made->fine = 0;
    return 1;
}

/* What only numbers of two doubles need. */
static void hc_make_finer(hc_ended_sweep *made) {
    const double more = 4 * HC_FINE_SLACK * made->sweep.slack;
    double shape[10] = {0};
    int k;
    if (made->fine) return;
    memcpy(shape, made->row, 4 * sizeof *shape);
    if (made->axis) memcpy(shape + 7, made->axis, 3 * sizeof *shape);
    else shape[9] = 1;
    (void)hc_make_sections(&made->between, shape); /* it is made: so is the larger one */
    made->outer = hc_make_fine(shape, more);
    made->inner = hc_make_fine(shape, -more);
    for (k = 0; k < 3; k++) made->moved[k] = hc_two_sum(made->row[7 + k], -made->row[4 + k]);
    made->fine = 1;
}

static void hc_center_at(const hc_ended_sweep *made, double time, double center[3]) {
    int k;
    for (k = 0; k < 3; k++) center[k] = made->sweep.from[k] + time * made->sweep.change[k];
}

/* The form of the sections that are placed at a time, about a height w. */
static hc_form hc_form_about(const hc_ended_sweep *made, const hc_sections *pair, double lambda_, double w) {
    const double f1 = lambda_ * pair->mu1 / (pair->mu1 + lambda_), f2 = lambda_ * pair->mu2 / (pair->mu2 + lambda_);
    const double t = w - pair->z, xi = pair->xi0 - pair->k * t, drift = made->aside + pair->k * made->rise;
    const double g = pair->ratio * pair->alpha, l2 = lambda_ * (g * g);
    hc_form form;
    form.value = t * t / pair->T - 1 - lambda_ * (pair->alpha * pair->alpha) - l2 * (w * w) + f1 * (pair->eta * pair->eta) + f2 * (xi * xi);
    form.by_height = 2 * (t / pair->T - l2 * w - f2 * (xi * pair->k));
    form.by_time = 2 * (f1 * (pair->eta * made->off) + f2 * (xi * drift) - t * made->rise / pair->T);
    form.xx = 1 / pair->T - l2 + f2 * (pair->k * pair->k);
    form.xy = -made->rise / pair->T - f2 * (pair->k * drift);
    form.yy = made->rise * made->rise / pair->T + f1 * (made->off * made->off) + f2 * (drift * drift);
    return form;
}

/* A bound of the errors of the form's terms together within these distances from its height and its time: each is right
   within 32u of its terms, f within 32u mu/(mu + lambda) of itself. Huge where numbers are too large. */
static double hc_form_error(const hc_ended_sweep *made, const hc_sections *pair, double lambda_, double w, double x, double y) {
    const double n1 = pair->mu1 + lambda_, n2 = pair->mu2 + lambda_, g = pair->ratio * pair->alpha;
    const double top = hc_size(w - pair->z) + x + hc_size(made->rise) * y, wide = hc_size(w) + x;
    const double side = pair->across + made->swift * y, along = side + hc_size(pair->k) * top;
    const double size = 1 + top * top / pair->T + hc_size(lambda_) * (pair->alpha * pair->alpha + g * g * (wide * wide)) +
                        hc_size(lambda_ * pair->mu1 / n1) * (side * side) * (1 + pair->mu1 / n1) +
                        hc_size(lambda_ * pair->mu2 / n2) * (along * along) * (1 + pair->mu2 / n2);
    if (!(n1 > pair->mu1 * HC_ENDED_NEAREST && n2 > pair->mu2 * HC_ENDED_NEAREST && size < HC_cap * HC_cap)) return DBL_MAX;
    return 4 * HC_ENDED_ERROR * size;
}

/* A number that the form is not below on a rectangle, but for its error. A form that bends upwards everywhere lies above
   its tangent plane; else the mixed term counts as a pull away from the height, or from the time. */
static double hc_form_least(const hc_form *form, const hc_rectangle *in, double w, double time) {
    const double below = w - in->low, above = in->high - w, before = time - in->first, after = in->last - time;
    const double x = below > above ? below : above, y = before > after ? before : after, mixed = 2 * hc_size(form->xy);
    const double first = hc_least_between(form->by_height, form->xx, mixed * y, below, above) +
                         hc_least_between(form->by_time, form->yy, 0, before, after);
    const double second = hc_least_between(form->by_height, form->xx, 0, below, above) +
                          hc_least_between(form->by_time, form->yy, mixed * x, before, after);
    double least = first > second ? first : second;
    if (form->xx > 0 && form->yy > 0 && form->xx * form->yy * (1 - HC_SMALL) > form->xy * form->xy) {
        const double plane = hc_least_between(form->by_height, 0, 0, below, above) + hc_least_between(form->by_time, 0, 0, before, after);
        if (plane > least) least = plane;
    }
    return form->value + least;
}

/* Moves a height and a time in a rectangle to about where max phi over lambda is least: the form with the bends that a
   lambda that follows adds to it. Any result is safe. */
static double hc_aim(const hc_ended_sweep *made, hc_sections *pair, const hc_rectangle *in, double *height, double *time) {
    double w = *height, at = *time, center[3];
    int i;
    for (i = 0;; i++) {
        const double drift = made->aside + pair->k * made->rise;
        double xi, lambda_, s1, s2, all, by_height, by_time, denominator, x, y;
        hc_form form;
        hc_center_at(made, at, center);
        hc_place_sections(pair, center);
        xi = pair->xi0 - pair->k * (w - pair->z);
        lambda_ = hc_ended_multiplier(pair, hc_radius(pair, w), xi);
        if (i == HC_AIMS) {
            *height = w, *time = at;
            return lambda_;
        }
        form = hc_form_about(made, pair, lambda_, w);
        s1 = pair->mu1 / (pair->mu1 + lambda_), s2 = pair->mu2 / (pair->mu2 + lambda_);
        all = 2 * (s1 * s1 * (pair->eta * pair->eta) / (pair->mu1 + lambda_) + s2 * s2 * (xi * xi) / (pair->mu2 + lambda_));
        by_height = -2 * (pair->ratio * pair->alpha * (pair->ratio * pair->alpha) * w + s2 * s2 * (xi * pair->k));
        by_time = 2 * (s1 * s1 * (pair->eta * made->off) + s2 * s2 * (xi * drift));
        if (all > 0) {
            form.xx += by_height * by_height / (2 * all);
            form.xy += by_height * by_time / (2 * all);
            form.yy += by_time * by_time / (2 * all);
        }
        denominator = form.xx * form.yy - form.xy * form.xy;
        if (denominator > 0 && form.xx > 0) {
            x = w - (form.by_height * form.yy - form.by_time * form.xy) / (2 * denominator);
            y = at - (form.by_time * form.xx - form.by_height * form.xy) / (2 * denominator);
            if (!(x >= in->low && x <= in->high)) {
                x = hc_kept_within(x, in->low, in->high);
                y = at - (form.by_time + 2 * form.xy * (x - w)) / (2 * form.yy);
            }
            if (!(y >= in->first && y <= in->last)) {
                y = hc_kept_within(y, in->first, in->last);
                x = w - (form.by_height + 2 * form.xy * (y - at)) / (2 * form.xx);
            }
        } else {
            x = form.by_height < 0 ? in->high : in->low;
            y = form.by_time < 0 ? in->last : in->first;
        }
        w = hc_kept_within(x, in->low, in->high), at = hc_kept_within(y, in->first, in->last);
    }
}

/* Whether a point of the circle at a height surely lies inside the smaller spheroid at a time. */
static int hc_surely_met(hc_ended_sweep *made, double lambda_, double w, double time) {
    static const double across[4] = {1, -1, 0, 0}, along[4] = {0, 0, 1, -1};
    hc_sections *const pair = &made->smaller;
    double center[3], r, xi;
    int k;
    hc_center_at(made, time, center);
    hc_place_sections(pair, center);
    r = hc_radius(pair, w);
    xi = pair->xi0 - pair->k * (w - pair->z);
    if (hc_point_within(pair, r, w, xi, pair->eta * pair->mu1 / (pair->mu1 + lambda_), xi * pair->mu2 / (pair->mu2 + lambda_))) return 1;
    for (k = 0; k < 4; k++)
        if (hc_point_within(pair, r, w, xi, across[k], along[k])) return 1;
    return 0;
}

/* hc_form_least less what the slopes and bends are off by, `height` and `time` of what each distance is at most. A form that
   bends upwards everywhere is not below the sum of two squares, each less a share |xy|/sqrt(xx yy) of its own. */
static double hc_form_least_surely(const hc_form *form, const hc_rectangle *in, double w, double time, const double pulls[2]) {
    const double below = w - in->low, above = in->high - w, before = time - in->first, after = in->last - time;
    const double x = below > above ? below : above, y = before > after ? before : after, mixed = 2 * hc_size(form->xy);
    const double first = hc_least_between(form->by_height, form->xx, mixed * y + pulls[0], below, above) +
                         hc_least_between(form->by_time, form->yy, pulls[1], before, after);
    const double second = hc_least_between(form->by_height, form->xx, pulls[0], below, above) +
                          hc_least_between(form->by_time, form->yy, mixed * x + pulls[1], before, after);
    double least = first > second ? first : second;
    if (form->xx > 0 && form->yy > 0) {
        const double root = hc_fine_root(form->xx) * hc_fine_root(form->yy), share = hc_size(form->xy) * (1 + HC_SMALL) / root;
        if (root > 0 && share < 1) {
            const double both = hc_least_between(form->by_height, form->xx * (1 - share), pulls[0], below, above) +
                                hc_least_between(form->by_time, form->yy * (1 - share), pulls[1], before, after);
            if (both > least) least = both;
        }
    }
    return least;
}

/* Whether there is contact at a time that is a whole number over HC_SIMPLE_TIMES, and at which the centre is three doubles:
   an exact position shows it. The time comes first in the product, so that what is left of it is 0 where it is exact. */
static int hc_touched_at(const hc_ended_sweep *made, double at, double *contact) {
    double row[13] = {0};
    int k;
    memcpy(row, made->row, 4 * sizeof *row);
    for (k = 0; k < 3; k++) {
        const hc_twin part = hc_two_product(at, made->moved[k].high), center = hc_two_sum(made->row[4 + k], part.high);
        if (made->moved[k].low != 0 || part.low != 0 || center.low != 0) return 0;
        if (at != 0 && made->moved[k].high != 0 && hc_size(part.high) < HC_ENDED_LEAST) return 0; /* it may lose bits */
        row[4 + k] = center.high;
    }
    if (made->axis) memcpy(row + 7, made->axis, 3 * sizeof *row);
    else row[9] = 1;
    row[10] = made->low, row[11] = made->high, row[12] = made->solid;
    if (hc_ended_position(row, hc_position_with(row, made->axis)) != 0) return 0;
    *contact = at;
    return 1;
}

/* The time from one to another that has the fewest bits behind the point; where it would have more than those of
   HC_SIMPLE_TIMES, the next that has so many. */
static double hc_simplest_time(double first, double last) {
    double unit = 1, at = 1;
    for (; unit <= HC_SIMPLE_TIMES; unit *= 2) {
        at = (double)(int64_t)(first * unit) / unit;
        if (at < first) at += 1 / unit;
        if (at <= last) break;
    }
    return at;
}

/* The same at the simplest time of a rectangle and at the one next to a time, if these are not after the last that is asked
   about; `asked` is the one that was asked last. */
static int hc_touched_about(const hc_ended_sweep *made, const hc_rectangle *in, double time, double last, double *asked, double *contact) {
    const double simplest = hc_simplest_time(in->first, in->last);
    const double next = (double)(int64_t)(time * HC_SIMPLE_TIMES + 0.5) / HC_SIMPLE_TIMES;
    const double before = *asked;
    *asked = simplest;
    return (simplest != before && simplest <= last && hc_touched_at(made, simplest, contact)) ||
           (next != simplest && next <= last && hc_touched_at(made, next, contact));
}

/* A rectangle by numbers of two doubles, about a height, a time and a lambda: 1 where it is surely clear, 0 where there is
   contact at *contact, 2 where neither is known, 3 where smaller rectangles may tell. */
static int hc_finely_missed(hc_ended_sweep *made, double lambda_, double w, double time, const hc_rectangle *in, double *contact) {
    const double x = in->high - in->low;
    hc_sections *const pair = &made->between;
    double center[3], a, c, r, xi, value, error, pulls[2];
    hc_form form;
    int k;
    hc_make_finer(made);
    hc_center_at(made, time, center);
    hc_place_sections(pair, center);
    {
        hc_twin at[3];
        for (k = 0; k < 3; k++) at[k] = hc_twin_sum(hc_twin_of(made->row[4 + k]), hc_twin_product(hc_twin_of(time), made->moved[k]));
        hc_place_fine(&made->outer, at[0], at[1], at[2]);
        hc_place_fine(&made->inner, at[0], at[1], at[2]);
    }
    r = hc_radius(pair, w);
    xi = pair->xi0 - pair->k * (w - pair->z);
    {
        const double n1 = pair->mu1 + lambda_, n2 = pair->mu2 + lambda_, g = pair->ratio * pair->alpha, g2 = g * g;
        const double top = hc_size(w) + x + made->tall, high = hc_size(w) + x, drift = made->swift + hc_size(pair->k * made->rise);
        const double along = made->wide + hc_size(pair->k) * top, one = hc_size(lambda_ * pair->mu1 / n1) * (1 + pair->mu1 / n1);
        const double two = hc_size(lambda_ * pair->mu2 / n2) * (1 + pair->mu2 / n2), across = r + along, l2 = hc_size(lambda_);
        const double size = 1 + top * top / pair->T + l2 * (pair->alpha * pair->alpha + g2 * (high * high)) +
                            one * (made->wide * made->wide) + two * (along * along);
        const double point = (pair->mu1 + pair->mu2) * (across * across) + top * top / pair->T + 1;
        if (!(n1 > pair->mu1 * HC_ENDED_NEAREST && n2 > pair->mu2 * HC_ENDED_NEAREST && size < HC_cap && point < HC_cap)) return 3;
        pulls[0] = 8 * HC_ENDED_ERROR * (top / pair->T + l2 * (g2 * high) + two * (along * hc_size(pair->k)));
        pulls[1] = 8 * HC_ENDED_ERROR * (one * (made->wide * made->swift) + two * (along * drift) + top * hc_size(made->rise) / pair->T);
        form = hc_form_about(made, pair, lambda_, w);
        value = hc_fine_phi(&made->outer, lambda_, w);
        error = HC_FINE_ERROR * size;
        if (value + hc_form_least_surely(&form, in, w, time, pulls) > error) return 1;
        hc_direction_of(pair, lambda_, r, xi, &a, &c);
        if (a * a + c * c > HC_ENDED_LEAST && a * a + c * c < HC_ENDED_GREATEST &&
            hc_fine_point(&made->inner, w, a, c) < -HC_FINE_ERROR * point) {
            *contact = time;
            return 0;
        }
        return hc_size(value) > 4 * (error + 4 * HC_FINE_SLACK * made->sweep.slack * size) ? 3 : 2;
    }
}

/* Cuts off the heights of a rectangle that the larger spheroid never reaches. Returns 0 where none is left. */
static int hc_cut_to_reach(const hc_ended_sweep *made, hc_rectangle *of) {
    double center[3], bottom, top;
    hc_center_at(made, of->first, center);
    bottom = top = center[2];
    hc_center_at(made, of->last, center);
    if (center[2] < bottom) bottom = center[2];
    if (center[2] > top) top = center[2];
    bottom -= made->reach + HC_u_8 * (hc_size(bottom) + made->reach);
    top += made->reach + HC_u_8 * (hc_size(top) + made->reach);
    if (of->low < bottom) of->low = bottom;
    if (of->high > top) of->high = top;
    return of->low <= of->high;
}

/* Whether the wall is surely missed from a time to another: 1; 0 where there is contact at *contact; else 2. */
static int hc_wall_missed_between(hc_ended_sweep *made, double first, double last, double *contact) {
    hc_rectangle kept[HC_RECTANGLES_KEPT];
    double asked = -1;
    int left = 1, seen = 0, unknown = 0;
    kept[0].low = made->low, kept[0].high = made->high, kept[0].first = first, kept[0].last = last;
    while (left) {
        hc_rectangle in = kept[--left];
        double w, time, lambda_, error, by_height, by_time, half;
        hc_form form;
        if (!hc_cut_to_reach(made, &in)) continue;
        w = hc_kept_within(in.low + 0.5 * (in.high - in.low), in.low, in.high);
        time = hc_kept_within(in.first + 0.5 * (in.last - in.first), in.first, in.last);
        lambda_ = hc_aim(made, &made->larger, &in, &w, &time);
        form = hc_form_about(made, &made->larger, lambda_, w);
        error = hc_form_error(made, &made->larger, lambda_, w, in.high - in.low, in.last - in.first);
        if (hc_form_least(&form, &in, w, time) > error) continue;
        if (hc_surely_met(made, lambda_, w, time)) {
            *contact = time;
            return 0;
        }
        if (hc_size(form.value) <= HC_NEAR_CONTACT * error * (1 + made->sweep.slack / HC_ENDED_ERROR)) {
            const int finely = hc_finely_missed(made, lambda_, w, time, &in, contact);
            if (finely == 0 || (finely > 1 && hc_touched_about(made, &in, time, last, &asked, contact))) return 0;
            if (finely == 2) unknown = 1;
            if (finely < 3) continue;
        }
        by_height = (hc_size(form.by_height) + hc_size(form.xx) * (in.high - in.low)) * (in.high - in.low);
        by_time = (hc_size(form.by_time) + hc_size(form.yy) * (in.last - in.first)) * (in.last - in.first);
        half = by_height > by_time ? in.low + 0.5 * (in.high - in.low) : in.first + 0.5 * (in.last - in.first);
        if (++seen > HC_MOST_RECTANGLES || left + 2 > HC_RECTANGLES_KEPT) return 2;
        kept[left] = kept[left + 1] = in;
        if (by_height > by_time) kept[left].low = kept[left + 1].high = half;
        else kept[left].first = kept[left + 1].last = half;
        if (by_height > by_time ? !(half > in.low && half < in.high) : !(half > in.first && half < in.last)) return 2;
        left += 2;
    }
    return unknown ? 2 : 1;
}

/* Whether the spheroid, by numbers of two doubles, surely stays on one side of the plane at a height: as it lies beyond it
   at both times. The error is as in hc_finely_missed, of the first of its terms. */
static int hc_finely_beyond(hc_ended_sweep *made, double w, double first, double last) {
    double sides[2];
    int k;
    hc_make_finer(made);
    for (k = 0; k < 2; k++) {
        const hc_twin moved = hc_twin_product(hc_twin_of(k ? last : first), made->moved[2]);
        const hc_twin t = hc_twin_difference(hc_twin_of(w), hc_twin_sum(hc_twin_of(made->row[6]), moved));
        const double top = hc_size(w) + made->tall, size = 1 + top * top / made->between.T;
        if (!(size < HC_cap && hc_fine_share(&made->outer, t).high > HC_FINE_ERROR * size)) return 0;
        sides[k] = t.high;
    }
    return (sides[0] > 0) == (sides[1] > 0);
}

/* Whether the centre of the ellipse in the plane at a height surely lies outside the rim at a time, as the sections of the
   smaller spheroid are placed, and at all times within 4u of it. A coordinate is off by less than 8u of both its ends. */
static int hc_center_beyond_rim(const hc_ended_sweep *made, double w) {
    const hc_sections *const pair = &made->smaller;
    const double xi = pair->xi0 - pair->k * (w - pair->z), r = hc_radius(pair, w);
    const double along = made->wide + hc_size(pair->k) * (hc_size(w) + made->tall);
    return pair->eta * pair->eta + xi * xi - r * r > 2 * HC_ENDED_ERROR * (along * along + made->wide * made->wide + r * r);
}

/* The same of the disc at a height, whose rim the spheroid misses all the time. While it meets the plane, which is from one
   time to another, it stays within the rim or outside, and so does the centre of its ellipse in the plane: that tells at
   the time at which its centre is nearest to the plane, which is one of those, if there are any. If that is an end of the
   sweep, at which there is no contact, there is none at any time: the computed time is off by 4u, in which the centre moves
   by less than a quarter of the radius, as the slack is below 1/4. */
static int hc_disc_missed_between(hc_ended_sweep *made, double w, double first, double last, double *contact) {
    const double time = hc_kept_within(made->rise == 0 ? first : (w - made->sweep.from[2]) / made->rise, first, last);
    double center[3], under[2], share, near;
    int misses;
    if ((time == 0 && made->clear[0]) || (time == 1 && made->clear[1])) return 1;
    hc_center_at(made, first, center);
    under[0] = (w - center[2]) * (1 - HC_ENDED_ERROR);
    hc_center_at(made, last, center);
    under[1] = (w - center[2]) * (1 - HC_ENDED_ERROR);
    if ((under[0] > made->reach && under[1] > made->reach) || (under[0] < -made->reach && under[1] < -made->reach)) return 1;
    near = made->reach * (1 - HC_SMALL);
    if (hc_size(under[0]) > near && hc_size(under[1]) > near && hc_finely_beyond(made, w, first, last)) return 1;
    hc_center_at(made, time, center);
    hc_place_sections(&made->smaller, center);
    if (hc_center_beyond_rim(made, w)) return 1;
    share = (w - center[2]) * (w - center[2]) / made->smaller.T;
    misses = hc_disc_misses(&made->smaller, w);
    if (misses == 0) *contact = time;
    return 1 - share > HC_ENDED_ERROR * (share + 1) ? misses : 2;
}

/* Whether wall and discs are surely missed from a time to another: 1; 0 where there is contact at *contact; else 2. */
static int hc_missed_between(hc_ended_sweep *made, double first, double last, double *contact) {
    const double ends[2] = {made->low, made->high};
    int missed = made->wall ? hc_wall_missed_between(made, first, last, contact) : 1, k;
    for (k = 0; made->solid && k < 2 && missed == 1; k++)
        if (hc_size(ends[k]) <= HC_ENDED_GREATEST) missed = hc_disc_missed_between(made, ends[k], first, last, contact);
    return missed;
}

static int hc_ended_position_at(const hc_ended_sweep *made, const double *axis, double time, double scale) {
    double row[13] = {0};
    hc_sweep_at(&made->sweep, time, scale, row);
    if (axis) memcpy(row + 7, axis, 3 * sizeof *axis);
    else row[9] = 1;
    row[10] = made->low, row[11] = made->high, row[12] = made->solid;
    return hc_ended_position(row, hc_position_with(row, axis));
}

/* A time before which there is no contact, and at which a spheroid that is a little larger has contact, in the sense of
   hypcheck_passage; NaN where none is found. */
static double hc_first_time(hc_ended_sweep *made, const double *axis, double contact) {
    double clear = 0;
    int i, unknown = 0;
    for (i = 0; i < HC_TIMES && unknown < HC_MOST_UNKNOWN; i++) {
        const double middle = clear + 0.5 * (contact - clear);
        double met = middle;
        int missed;
        if (!(middle > clear && middle < contact)) break;
        missed = hc_missed_between(made, clear, middle, &met);
        if (missed == 1) clear = middle;
        else contact = met < middle ? met : middle; /* or no more is known before it */
        unknown = missed == 2 ? unknown + 1 : 0;
    }
    return hc_ended_position_at(made, axis, clear, 1 + HC_SEEN * made->sweep.slack) == 0 ? clear : hc_nothing_known();
}

/* As hc_passage_of, for a valid row with heights behind the axis. */
static int hc_ended_passage(const double row[16], const double *axis, double *time) {
    const double reach = row[2] > row[3] ? row[2] : row[3], low = row[13], high = row[14];
    const double bottom = row[6] < row[9] ? row[6] : row[9], top = row[6] < row[9] ? row[9] : row[6];
    const double ends = (hc_size(low) <= HC_ENDED_GREATEST ? hc_size(low) : 0) + (hc_size(high) <= HC_ENDED_GREATEST ? hc_size(high) : 0);
    const double more = reach + HC_u_8 * (hc_size(bottom) + hc_size(top) + reach + ends);
    const int solid = row[15] != 0;
    double places[2][13], contact = 1;
    int positions[2], whole[2], endless, known, k;
    hc_ended_sweep made;
    if (bottom - low > more && high - top > more) return hc_passage_of(row, axis, time);
    if (low - top > more || bottom - high > more) return 0;
    for (k = 0; k < 2; k++) {
        memcpy(places[k], row, 4 * sizeof *row);
        memcpy(places[k] + 4, row + 4 + 3 * k, 3 * sizeof *row);
        memcpy(places[k] + 7, row + 10, 6 * sizeof *row);
        whole[k] = hc_position_with(places[k], axis);
        positions[k] = hc_ended_position(places[k], whole[k]);
    }
    if (positions[0] == 0) {
        if (time) *time = 0;
        return 1;
    }
    known = positions[1] == 0 || (solid && positions[0] != 2 && positions[1] != 2 && positions[0] != positions[1]);
    if (known && !time) return 1;
    endless = hc_passage_of(row, axis, NULL);
    if (endless == 0 && (!solid || whole[0] == 1)) return 0;
    if (!hc_make_ended_sweep(&made, row, axis)) return known ? 1 : 2;
    made.wall = endless != 0;
    for (k = 0; k < 2; k++) made.clear[k] = positions[k] == 1 || positions[k] == -1;
    k = hc_missed_between(&made, 0, 1, &contact);
    if (k && !known) return k == 1 ? 0 : 2;
    if (time) *time = hc_first_time(&made, axis, contact);
    return 1;
}

/* The rows of a question about sweeps: 10, 13 or 16 numbers each. */
void hypcheck_passage_columns(size_t n, size_t width, const double *rows, int8_t *hits, double *times) {
    const double nan = hc_nothing_known();
    size_t i;
    for (i = 0; i < n; i++) {
        const double *const given = rows + width * i;
        double row[16] = {0}, end[7], *const axis = row + 10, *const heights = row + 13;
        int valid = width == 10 || width == 13 || width == 16, is_tilted;
        if (times) times[i] = nan;
        hits[i] = 127;
        if (!valid) continue;
        row[12] = 1;
        memcpy(row, given, width * sizeof *row);
        memcpy(end, row, 4 * sizeof *row);
        memcpy(end + 4, row + 7, 3 * sizeof *row);
        if (width == 16) valid = heights[0] < heights[1] && (heights[2] == 0 || heights[2] == 1);
        if (!(valid && hc_has_direction(axis) && hc_valid(row) && hc_valid(end))) continue;
        is_tilted = !((hc_word(axis[0]) | hc_word(axis[1])) << 1 == 0 || hc_word(row[2]) == hc_word(row[3]));
        hc_scale_axis(axis);
        hits[i] = (int8_t)(width == 16 && !(heights[0] < -DBL_MAX && heights[1] > DBL_MAX)
                               ? hc_ended_passage(row, is_tilted ? axis : NULL, times ? times + i : NULL)
                               : hc_passage_of(row, is_tilted ? axis : NULL, times ? times + i : NULL));
    }
}

void hypcheck_passage(size_t n, const double *rows10, int8_t *hits, double *times) { hypcheck_passage_columns(n, 10, rows10, hits, times); }

void hypcheck_passage_tilted(size_t n, const double *rows13, int8_t *hits, double *times) {
    hypcheck_passage_columns(n, 13, rows13, hits, times);
}

void hypcheck_classify_columns(size_t n, size_t width, const double *rows, int8_t *positions) {
    if (width == 7) hypcheck_classify(n, rows, positions);
    else if (width == 10) hypcheck_classify_tilted(n, rows, positions);
    else if (width == 13) hypcheck_classify_ended(n, rows, positions);
    else hc_refuse_all(n, positions);
}
