// Suga et al. 2015, Comput. Math. Appl. 69:518, D3Q27 directions; opposites are neighbours (2k-1, 2k).

// Direction q moves by C[q].
const C = array<vec3<i32>, 27>(
    vec3(0, 0, 0),
    vec3(1, 0, 0), vec3(-1, 0, 0),
    vec3(0, 1, 0), vec3(0, -1, 0),
    vec3(0, 0, 1), vec3(0, 0, -1),
    vec3(1, 1, 0), vec3(-1, -1, 0),
    vec3(1, 0, 1), vec3(-1, 0, -1),
    vec3(0, 1, 1), vec3(0, -1, -1),
    vec3(1, -1, 0), vec3(-1, 1, 0),
    vec3(1, 0, -1), vec3(-1, 0, 1),
    vec3(0, 1, -1), vec3(0, -1, 1),
    vec3(1, 1, 1), vec3(-1, -1, -1),
    vec3(1, 1, -1), vec3(-1, -1, 1),
    vec3(1, -1, 1), vec3(-1, 1, -1),
    vec3(-1, 1, 1), vec3(1, -1, -1),
);

// Index of direction q in tensor order, (1 + c_x) + 3 (1 + c_y) + 9 (1 + c_z), the order of the factorised
// transforms of moments.wgsl.
const T = array<u32, 27>(
    13u, 14u, 12u, 16u, 10u, 22u, 4u,
    17u, 9u, 23u, 3u, 25u, 1u, 11u, 15u, 5u, 21u, 7u, 19u,
    26u, 0u, 8u, 18u, 20u, 6u, 24u, 2u,
);
