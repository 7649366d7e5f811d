package main

import "math"

// description is what the predicate claims. Before "binary", "times":true says that times go with hits, and "tilt":true
// that it is asked about tilted spheroids: tilted answers all rows then.
const description = `{"protocol":1,"name":"@NAME@","version":"0.0.0","language":"go","precision":"float64",` +
	`"question":"passage","binary":true,"time":true}`

// predicate tells when the spheroid with semi-axes b, b, d, whose centre goes straight from (x0, y0, z0) at time 0 to
// (x1, y1, z1) at time 1, first touches x²/alpha² + y²/alpha² − z²/gamma² = 1: from 0 to 1, or −1 where it is clear all
// the way.
//
// Replace this with your predicate, or with a call of it. The stub takes the spheroid for its centre: right where that
// goes through the wall, though late, and wrong where only the body touches it.
func predicate(alpha, gamma, b, d, x0, y0, z0, x1, y1, z1 float64) float64 {
	x, y, z := x0/alpha, y0/alpha, z0/gamma
	u, v, w := (x1-x0)/alpha, (y1-y0)/alpha, (z1-z0)/gamma
	p, q, r := u*u+v*v-w*w, x*u+y*v-z*w, x*x+y*y-z*z-1
	root := math.Sqrt(q*q - p*r) // p t² + 2 q t + r = 0
	s := -(q + math.Copysign(root, q))
	first, last := s/p, r/s
	if first > last {
		first, last = last, first
	}
	if first >= 0 && first <= 1 {
		return first
	}
	if last >= 0 && last <= 1 {
		return last
	}
	return -1
}

// tilted is the same with the spheroid's axis of revolution along (axisX, axisY, axisZ) all the way, a vector of any
// length and sign. The stub ignores it. Asked only with "tilt":true.
func tilted(alpha, gamma, b, d, x0, y0, z0, x1, y1, z1, axisX, axisY, axisZ float64) float64 {
	return predicate(alpha, gamma, b, d, x0, y0, z0, x1, y1, z1)
}
