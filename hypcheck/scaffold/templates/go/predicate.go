package main

// description is what the predicate claims. "question" may be position (+1 exterior, 0 contact, -1 interior), exterior,
// interior or contact (1 yes, 0 no). Table 2 claims to be right where (gamma/d)² ≥ alpha/b; without "domain" all sizes
// are asked. With "tilt":true before "binary" it is asked about tilted spheroids: tilted answers all rows then.
const description = `{"protocol":1,"name":"@NAME@","version":"0.0.0","language":"go","precision":"float64",` +
	`"question":"exterior","domain":{"regimes":["c2>=a"]},"binary":true,"time":true}`

// predicate tells whether the spheroid with semi-axes b, b, d and centre (x, y, z) is exterior to
// x²/alpha² + y²/alpha² − z²/gamma² = 1.
//
// Replace this with your predicate, or with a call of it. The stub is Table 2 (Procedure 1) of "Algorithms for
// Determining Relative Position between Spheroids and Hyperboloids with One Sheet": right in the paper's scenes, wrong
// on the ring, where its discriminant vanishes far from the surface.
func predicate(alpha, gamma, b, d, x, y, z float64) int8 {
	A := (alpha / b) * (alpha / b)
	B := (gamma / d) * (gamma / d)
	c0 := -(A * B)
	C := c0 + A - B

	P := (x*x + y*y) / (b * b)
	Q := (z / d) * (z / d)
	c1 := C + B*P - A*Q
	c2 := A - B + 1 - P - Q
	delta := -4*(c2*c2*c2)*c0 + (c2*c1)*(c2*c1) + 18*c2*c1*c0 - 4*(c1*c1*c1) - 27*(c0*c0)
	if delta > 0 && c2 < 0 && c1 > 0 {
		return 1
	}
	return 0
}

// tilted is the same with the spheroid's axis of revolution along (axisX, axisY, axisZ), a vector of any length and sign,
// upright where axisX = axisY = 0. The stub ignores it: wrong as soon as the spheroid is tilted. Asked only with "tilt":true.
func tilted(alpha, gamma, b, d, x, y, z, axisX, axisY, axisZ float64) int8 {
	return predicate(alpha, gamma, b, d, x, y, z)
}
