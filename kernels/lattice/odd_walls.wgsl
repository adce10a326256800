// Odd moments beside walls as wall_rates.wgsl says.
// needs wall_rates, $saturation

fn odd_rates(cell: u32, saturation: Saturation) -> OddRates {
    return wall_rates(cell);
}
