// Values of an element are stored as they are computed.
// needs $lanes

alias Reals = Real;

fn unpack_reals(kept: Reals) -> Real {
    return kept;
}

fn pack_reals(value: Real) -> Reals {
    return value;
}
