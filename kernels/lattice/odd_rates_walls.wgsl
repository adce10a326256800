// Odd moments next to walls as wall_rates.wgsl says.
// needs wall_rates, $psm

fn odd_rates(cell: u32, psm: PsmCell) -> OddRates {
    return wall_rates(cell);
}
