/** The predicate under test. */
final class Predicate {
    /**
     * What it claims. "question" may be position (+1 exterior, 0 contact, -1 interior), exterior, interior or contact
     * (1 yes, 0 no). Table 2 claims to be right where (gamma/d)^2 >= alpha/b; without "domain" all sizes are asked.
     * With \"tilt\":true before \"binary\" it is asked about tilted spheroids: tilted answers all rows then.
     */
    static final String DESCRIPTION =
            "{\"protocol\":1,\"name\":\"@NAME@\",\"version\":\"0.0.0\",\"language\":\"java\",\"precision\":\"float64\","
                    + "\"question\":\"exterior\",\"domain\":{\"regimes\":[\"c2>=a\"]},\"binary\":true,\"time\":true}";

    private Predicate() {}

    /**
     * Whether the spheroid with semi-axes b, b, d and centre (x, y, z) is exterior to
     * x^2/alpha^2 + y^2/alpha^2 - z^2/gamma^2 = 1.
     *
     * <p>Replace this with your predicate, or with a call of it. The stub is Table 2 (Procedure 1) of "Algorithms for
     * Determining Relative Position between Spheroids and Hyperboloids with One Sheet": right in the paper's scenes,
     * wrong on the ring, where its discriminant vanishes far from the surface.
     */
    static int predicate(double alpha, double gamma, double b, double d, double x, double y, double z) {
        double A = (alpha / b) * (alpha / b);
        double B = (gamma / d) * (gamma / d);
        double c0 = -(A * B);
        double C = c0 + A - B;

        double P = (x * x + y * y) / (b * b);
        double Q = (z / d) * (z / d);
        double c1 = C + B * P - A * Q;
        double c2 = A - B + 1 - P - Q;
        double delta =
                -4 * (c2 * c2 * c2) * c0
                        + (c2 * c1) * (c2 * c1)
                        + 18 * c2 * c1 * c0
                        - 4 * (c1 * c1 * c1)
                        - 27 * (c0 * c0);
        return delta > 0 && c2 < 0 && c1 > 0 ? 1 : 0;
    }

    /**
     * The same with the spheroid's axis of revolution along (axisX, axisY, axisZ), a vector of any length and sign,
     * upright where axisX = axisY = 0. The stub ignores it: wrong as soon as the spheroid is tilted.
     */
    static int tilted(
            double alpha, double gamma, double b, double d, double x, double y, double z,
            double axisX, double axisY, double axisZ) {
        return predicate(alpha, gamma, b, d, x, y, z);
    }
}
