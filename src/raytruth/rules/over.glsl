// A slab is a vec4: the light C that it sends to its front, and its opacity A; vec4(0.0) is the empty one.
//
//     over: C = C_f + (1 - A_f) C_b,  A = A_f + (1 - A_f) A_b   (Porter and Duff 1984, with associated colours).
//
// Opacities are summed up as such, not as 1 - T, so that faint slabs keep their digits.

vec4 over(vec4 front, vec4 back) {
  return front + (1.0 - front[3]) * back;
}
