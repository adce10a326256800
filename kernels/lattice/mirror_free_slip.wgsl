// Ladd 1994, J. Fluid Mech. 271:285, specular reflection: beyond a free-slip face a solid continues as its mirror image. A direction
// from a full cell at this face that passes through the face leads to the image of a cell inside. What the solid returns there, the
// image of the full cell returns to the cell inside, in the reflected direction.
// needs incoming, sloping_cell

// The word that the cell in direction q from a full cell, or its image inside, loads next.
fn returned(at: Neighbourhood, slope: u32, q: u32) -> Word {
    let c = C[q];
    let faces = slope >> SLOPE_FREE_SLIP;
    let through = vec3(
        c.x != 0 && (faces & select(1u, 2u, c.x > 0)) != 0u,
        c.y != 0 && (faces & select(4u, 8u, c.y > 0)) != 0u,
        c.z != 0 && (faces & select(16u, 32u, c.z > 0)) != 0u,
    );
    let p = direction_along(abs(c), (c < vec3(0)) != through);
    // The full cell or its image, and the cell inside.
    let source = select(vec3(at.x[1], at.y[1], at.z[1]), vec3(at.x[1 + c.x], at.y[1 + c.y], at.z[1 + c.z]), through);
    let inside = select(vec3(at.x[1 + c.x], at.y[1 + c.y], at.z[1 + c.z]), vec3(at.x[1], at.y[1], at.z[1]), through);
    if ((p & 1u) == 1u) {
        return Word(p + 1u - cell_pass.odd, inside.x + inside.y + inside.z);
    }
    return Word(p - 1u + cell_pass.odd, source.x + source.y + source.z);
}

// The number of a direction other than 0, from the sizes of its components and which of them are negative.
fn direction_along(size: vec3<i32>, negative: vec3<bool>) -> u32 {
    let x = select(0u, 1u, negative.x);
    let y = select(0u, 1u, negative.y);
    let z = select(0u, 1u, negative.z);
    switch size.x + size.y + size.z {
        case 1: {
            return select(select(5u + z, 3u + y, size.y == 1), 1u + x, size.x == 1);
        }
        case 2: {
            let first = select(y, x, size.x == 1);
            let second = select(y, z, size.z == 1);
            let axes = select(select(7u, 9u, size.y == 0), 11u, size.x == 0);
            return axes + first + select(0u, 6u, first != second);
        }
        default: {
            // The sign that differs is that of x, y, z, or none.
            let differs = select(select(select(6u, 4u, x == z), 2u, x == y), 0u, x == y && y == z);
            return 19u + differs + select(x, y, differs == 6u);
        }
    }
}
