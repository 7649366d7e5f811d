/* ---- one instruction set: vectors of HC_WIDTH doubles; included once for each ---- */

#if HC_LEVEL == 3
#define HC_NAME(name) name##_avx512
#define HC_TARGET __attribute__((target("avx512f,avx512bw,avx512dq,avx512vl,fma,bmi2")))
#define HC_WIDTH 8
#define HC_NUMBER __m512d
#define HC_TRUTH __mmask8
#define HC_LOAD(from) _mm512_loadu_pd(from)
#define HC_SET(value) _mm512_set1_pd(value)
#define HC_ABS(a) _mm512_abs_pd(a)
#define HC_GT(a, b) _mm512_cmp_pd_mask(a, b, _CMP_GT_OQ)
#define HC_LT(a, b) _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ)
#define HC_GE(a, b) _mm512_cmp_pd_mask(a, b, _CMP_GE_OQ)
#define HC_LE(a, b) _mm512_cmp_pd_mask(a, b, _CMP_LE_OQ)
#define HC_AND(a, b) ((HC_TRUTH)((a) & (b)))
#define HC_OR(a, b) ((HC_TRUTH)((a) | (b)))
#define HC_BITS(truth) ((uint64_t)(truth))
#define HC_SQRT(a) hc_about_root_avx512(a)
#define HC_INVERSE(a) hc_about_inverse_avx512(a)
#define HC_ROOT(a) _mm512_sqrt_pd(a)
#define HC_STORE(to, a) _mm512_storeu_pd(to, a)
#define HC_MIN(a, b) _mm512_min_pd(a, b)
#define HC_MAX(a, b) _mm512_max_pd(a, b)
#define HC_SELECT(truth, a, b) _mm512_mask_blend_pd(truth, b, a)
#elif HC_LEVEL == 2
#define HC_NAME(name) name##_avx2
#define HC_TARGET __attribute__((target("avx2,fma,bmi2")))
#define HC_WIDTH 4
#define HC_NUMBER __m256d
#define HC_TRUTH __m256d
#define HC_LOAD(from) _mm256_loadu_pd(from)
#define HC_SET(value) _mm256_set1_pd(value)
#define HC_ABS(a) _mm256_andnot_pd(_mm256_set1_pd(-0.0), a)
#define HC_GT(a, b) _mm256_cmp_pd(a, b, _CMP_GT_OQ)
#define HC_LT(a, b) _mm256_cmp_pd(a, b, _CMP_LT_OQ)
#define HC_GE(a, b) _mm256_cmp_pd(a, b, _CMP_GE_OQ)
#define HC_LE(a, b) _mm256_cmp_pd(a, b, _CMP_LE_OQ)
#define HC_AND(a, b) _mm256_and_pd(a, b)
#define HC_OR(a, b) _mm256_or_pd(a, b)
#define HC_BITS(truth) ((uint64_t)_mm256_movemask_pd(truth))
#define HC_SQRT(a) _mm256_sqrt_pd(a)
#define HC_INVERSE(a) (HC_SET(1.0) / (a))
#define HC_ROOT(a) _mm256_sqrt_pd(a)
#define HC_STORE(to, a) _mm256_storeu_pd(to, a)
#define HC_MIN(a, b) _mm256_min_pd(a, b)
#define HC_MAX(a, b) _mm256_max_pd(a, b)
#define HC_SELECT(truth, a, b) _mm256_blendv_pd(b, a, truth)
#elif HC_LEVEL == 1
#define HC_NAME(name) name##_sse2
#define HC_TARGET
#define HC_WIDTH 2
#define HC_NUMBER __m128d
#define HC_TRUTH __m128d
#define HC_LOAD(from) _mm_loadu_pd(from)
#define HC_SET(value) _mm_set1_pd(value)
#define HC_ABS(a) _mm_andnot_pd(_mm_set1_pd(-0.0), a)
#define HC_GT(a, b) _mm_cmpgt_pd(a, b)
#define HC_LT(a, b) _mm_cmplt_pd(a, b)
#define HC_GE(a, b) _mm_cmpge_pd(a, b)
#define HC_LE(a, b) _mm_cmple_pd(a, b)
#define HC_AND(a, b) _mm_and_pd(a, b)
#define HC_OR(a, b) _mm_or_pd(a, b)
#define HC_BITS(truth) ((uint64_t)_mm_movemask_pd(truth))
#define HC_SQRT(a) _mm_sqrt_pd(a)
#define HC_INVERSE(a) (HC_SET(1.0) / (a))
#define HC_ROOT(a) _mm_sqrt_pd(a)
#define HC_STORE(to, a) _mm_storeu_pd(to, a)
#define HC_MIN(a, b) _mm_min_pd(a, b)
#define HC_MAX(a, b) _mm_max_pd(a, b)
#define HC_SELECT(truth, a, b) _mm_or_pd(_mm_and_pd(truth, a), _mm_andnot_pd(truth, b))
#elif HC_LEVEL == 4
#define HC_NAME(name) name##_neon
#define HC_TARGET
#define HC_WIDTH 2
#define HC_NUMBER float64x2_t
#define HC_TRUTH uint64x2_t
#define HC_LOAD(from) vld1q_f64(from)
#define HC_SET(value) vdupq_n_f64(value)
#define HC_ABS(a) vabsq_f64(a)
#define HC_GT(a, b) vcgtq_f64(a, b)
#define HC_LT(a, b) vcltq_f64(a, b)
#define HC_GE(a, b) vcgeq_f64(a, b)
#define HC_LE(a, b) vcleq_f64(a, b)
#define HC_AND(a, b) vandq_u64(a, b)
#define HC_OR(a, b) vorrq_u64(a, b)
#define HC_BITS(truth) ((vgetq_lane_u64(truth, 0) & 1) | (vgetq_lane_u64(truth, 1) & 2))
#define HC_SQRT(a) vsqrtq_f64(a)
#define HC_INVERSE(a) (HC_SET(1.0) / (a))
#define HC_ROOT(a) vsqrtq_f64(a)
#define HC_STORE(to, a) vst1q_f64(to, a)
#define HC_MIN(a, b) vbslq_f64(vcltq_f64(a, b), a, b)
#define HC_MAX(a, b) vbslq_f64(vcgtq_f64(a, b), a, b)
#define HC_SELECT(truth, a, b) vbslq_f64(truth, a, b)
#else
#define HC_NAME(name) name##_plain
#define HC_TARGET
#define HC_WIDTH 1
#define HC_NUMBER double
#define HC_TRUTH int
#define HC_LOAD(from) (*(from))
#define HC_SET(value) (value)
#define HC_ABS(a) ((a) < 0 ? -(a) : (a))
#define HC_GT(a, b) ((a) > (b))
#define HC_LT(a, b) ((a) < (b))
#define HC_GE(a, b) ((a) >= (b))
#define HC_LE(a, b) ((a) <= (b))
#define HC_AND(a, b) ((a) & (b))
#define HC_OR(a, b) ((a) | (b))
#define HC_BITS(truth) ((uint64_t)(truth))
#define HC_SQRT(a) hc_rough_root(a)
#define HC_INVERSE(a) (HC_SET(1.0) / (a))
#define HC_ROOT(a) hc_fine_root(a)
#define HC_STORE(to, a) (*(to) = (a))
#define HC_MIN(a, b) ((a) < (b) ? (a) : (b))
#define HC_MAX(a, b) ((a) > (b) ? (a) : (b))
#define HC_SELECT(truth, a, b) ((truth) ? (a) : (b))
#endif

#if HC_LEVEL == 3
/* Within 2^-26, for guesses that prove nothing, in a quarter of the time: a step of Newton's method after 14 bits. */
HC_TARGET static inline __m512d hc_about_inverse_avx512(__m512d a) {
    const __m512d guess = _mm512_rcp14_pd(a);
    return guess * (_mm512_set1_pd(2.0) - a * guess);
}
HC_TARGET static inline __m512d hc_about_root_avx512(__m512d a) {
    const __m512d guess = _mm512_rsqrt14_pd(a), root = a * guess;
    return root * (_mm512_set1_pd(1.5) - _mm512_set1_pd(0.5) * root * guess);
}
#endif

HC_TARGET static int HC_NAME(hc_all_below)(HC_NUMBER numbers, double limit) {
    return HC_BITS(HC_LT(numbers, HC_SET(limit))) == ((uint64_t)1 << HC_WIDTH) - 1;
}

/* 64 bytes: 1 where `plus` has a bit, -1 where `minus` has one, else 0. */
HC_TARGET static void HC_NAME(hc_spread)(int8_t *bytes, uint64_t plus, uint64_t minus) {
#if HC_LEVEL == 3
    const __m512i ones = _mm512_maskz_set1_epi8((__mmask64)plus, 1);
    _mm512_storeu_si512((void *)bytes, _mm512_mask_set1_epi8(ones, (__mmask64)minus, -1));
#elif HC_LEVEL == 2
    const __m256i place = _mm256_setr_epi64x(0, 0x0101010101010101, 0x0202020202020202, 0x0303030303030303);
    const __m256i bit = _mm256_set1_epi64x((long long)0x8040201008040201u);
    int half;
    for (half = 0; half < 2; half++) {
        const __m256i p = _mm256_shuffle_epi8(_mm256_set1_epi32((int)(uint32_t)(plus >> 32 * half)), place);
        const __m256i m = _mm256_shuffle_epi8(_mm256_set1_epi32((int)(uint32_t)(minus >> 32 * half)), place);
        const __m256i is_plus = _mm256_cmpeq_epi8(_mm256_and_si256(p, bit), bit);
        const __m256i is_minus = _mm256_cmpeq_epi8(_mm256_and_si256(m, bit), bit);
        _mm256_storeu_si256((__m256i *)(void *)(bytes + 32 * half),
                            _mm256_or_si256(is_minus, _mm256_sub_epi8(_mm256_setzero_si256(), is_plus)));
    }
#elif HC_LEVEL == 1
    const __m128i bit = _mm_set1_epi64x((long long)0x8040201008040201u);
    int part;
    for (part = 0; part < 4; part++) {
        const int p = (int)(plus >> 16 * part & 0xffff), m = (int)(minus >> 16 * part & 0xffff);
        const __m128i eight_p = _mm_unpacklo_epi64(_mm_set1_epi8((char)p), _mm_set1_epi8((char)(p >> 8)));
        const __m128i eight_m = _mm_unpacklo_epi64(_mm_set1_epi8((char)m), _mm_set1_epi8((char)(m >> 8)));
        const __m128i is_plus = _mm_cmpeq_epi8(_mm_and_si128(eight_p, bit), bit);
        const __m128i is_minus = _mm_cmpeq_epi8(_mm_and_si128(eight_m, bit), bit);
        _mm_storeu_si128((__m128i *)(void *)(bytes + 16 * part),
                         _mm_or_si128(is_minus, _mm_sub_epi8(_mm_setzero_si128(), is_plus)));
    }
#elif HC_LEVEL == 4
    const uint8x8_t bit = vcreate_u8(0x8040201008040201u);
    int part;
    for (part = 0; part < 8; part++) {
        const int8x8_t p = vreinterpret_s8_u8(vtst_u8(vdup_n_u8((uint8_t)(plus >> 8 * part)), bit));
        const int8x8_t m = vreinterpret_s8_u8(vtst_u8(vdup_n_u8((uint8_t)(minus >> 8 * part)), bit));
        vst1_s8(bytes + 8 * part, vsub_s8(m, p)); /* each is 0 or -1 */
    }
#else
    int i;
    for (i = 0; i < HC_BLOCK; i++) bytes[i] = (int8_t)((int)(plus >> i & 1) - (int)(minus >> i & 1));
#endif
}

HC_TARGET static void HC_NAME(hc_spread_all)(int8_t *bytes, const hc_signs *signs, size_t blocks) {
    size_t block;
    for (block = 0; block < blocks; block++)
        HC_NAME(hc_spread)(bytes + HC_BLOCK * block, signs[block].plus, signs[block].minus);
}

/* The second stage on at most HC_BLOCK rows; column k begins at columns + k stride and is readable up to a multiple of
   HC_WIDTH rows. */
HC_TARGET static hc_bits HC_NAME(hc_certified)(const double *columns, size_t stride, int count) {
    hc_bits found = {0, 0, 0};
    int at;
    @CERTIFIED_CONSTANTS@
    for (at = 0; at < count; at += HC_WIDTH) {
        @CERTIFIED_INPUTS@
        /* printed from the program "certified" */
        @CERTIFIED@
        /* end of the program "certified" */
        found.plus |= HC_BITS(exterior) << at;
        found.minus |= HC_BITS(interior) << at;
        found.decided |= HC_BITS(decided) << at;
    }
    return found;
}

/* The first stage on whole blocks of one scene: what it decides is in `signs`, and `left` has a bit for each other row. To
   collect these here would be a branch on data just loaded, and its misses cost more than the arithmetic. */
@LINE_FUNCTIONS@
@TILTED_LEVEL@
@NEAR_LEVEL@
#undef HC_NAME
#undef HC_TARGET
#undef HC_WIDTH
#undef HC_NUMBER
#undef HC_TRUTH
#undef HC_LOAD
#undef HC_SET
#undef HC_ABS
#undef HC_GT
#undef HC_LT
#undef HC_GE
#undef HC_LE
#undef HC_AND
#undef HC_OR
#undef HC_BITS
#undef HC_SQRT
#undef HC_INVERSE
#undef HC_ROOT
#undef HC_STORE
#undef HC_MIN
#undef HC_MAX
#undef HC_SELECT
