/** The predicate under test. */
final class Predicate {
    /**
     * What it claims. Before \"binary\", \"times\":true says that times go with hits, and \"tilt\":true that it is asked
     * about tilted spheroids: tilted answers all rows then.
     */
    static final String DESCRIPTION =
            "{\"protocol\":1,\"name\":\"@NAME@\",\"version\":\"0.0.0\",\"language\":\"java\",\"precision\":\"float64\","
                    + "\"question\":\"passage\",\"binary\":true,\"time\":true}";

    private Predicate() {}

    /**
     * When the spheroid with semi-axes b, b, d, whose centre goes straight from (x0, y0, z0) at time 0 to (x1, y1, z1) at
     * time 1, first touches x^2/alpha^2 + y^2/alpha^2 - z^2/gamma^2 = 1: from 0 to 1, or -1 where it is clear all the way.
     *
     * <p>Replace this with your predicate, or with a call of it. The stub takes the spheroid for its centre: right where
     * that goes through the wall, though late, and wrong where only the body touches it.
     */
    static double predicate(
            double alpha, double gamma, double b, double d,
            double x0, double y0, double z0, double x1, double y1, double z1) {
        double x = x0 / alpha, y = y0 / alpha, z = z0 / gamma;
        double u = (x1 - x0) / alpha, v = (y1 - y0) / alpha, w = (z1 - z0) / gamma;
        double p = u * u + v * v - w * w, q = x * u + y * v - z * w, r = x * x + y * y - z * z - 1;
        double root = Math.sqrt(q * q - p * r); // p t^2 + 2 q t + r = 0
        double s = -(q + Math.copySign(root, q)), one = s / p, other = r / s;
        double first = Math.min(one, other), last = Math.max(one, other);
        return first >= 0 && first <= 1 ? first : last >= 0 && last <= 1 ? last : -1;
    }

    /**
     * The same with the spheroid's axis of revolution along (axisX, axisY, axisZ) all the way, a vector of any length and
     * sign. The stub ignores it.
     */
    static double tilted(
            double alpha, double gamma, double b, double d,
            double x0, double y0, double z0, double x1, double y1, double z1,
            double axisX, double axisY, double axisZ) {
        return predicate(alpha, gamma, b, d, x0, y0, z0, x1, y1, z1);
    }
}
