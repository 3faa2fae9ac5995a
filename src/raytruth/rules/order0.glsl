// Order 0: the signal held at one value between two samples (El Hajjar 2008, section 3.2.1).
//
// Every rule gives the approximate signal between two samples as the Bernstein coefficients of a cubic in the local
// coordinate u, 0 at the front sample and 1 at the back one:
//     s(u) = b.x (1-u)^3 + 3 b.y u (1-u)^2 + 3 b.z u^2 (1-u) + b.w u^3.
//
// Exact for constants. Error O(h).

vec4 order0(real held) {
  return vec4(held, held, held, held);
}
