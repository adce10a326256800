// The odd moments relax at the rates of wall_rates.wgsl.
// needs wall_rates, $psm

fn odd_rates(cell: u32, psm: PsmCell) -> OddRates {
    return wall_rates(cell);
}
