//! Bodies that wear and grow films where they slip in the cycles of a loading.

use asperity_contact::motion::IncrementRecord;
use asperity_study::StaticResult;

use crate::resume::goes_on;
use crate::support::{at_rest, field, most, parsed, written};

/// Rough bodies, with wear under a film that grows.
const ROUGH: &str = r#"
lower = { young = "210 GPa", poisson = 0.3, hardness = "3 GPa", topography = { generate = "self-affine", shape = [32, 32], pitch = "1 um", hurst = 0.8, sq = "60 nm", shortest = "4 um", seed = 3 }, wear = { coefficient = "1e-5 mm3/(N m)", under_film = "1e-6 mm3/(N m)" }, film = { law = "mechano-chemical", max_thickness = "50 nm", x = 1e-14, c3 = "5 nm", c4 = 0.1, hardness = "1.5 GPa" } }
upper = { young = "70 GPa", poisson = 0.2, topography = { form = "flat" }, wear = { energy = "1e-5 mm3/J" } }
contact = { mean_pressure = "30 MPa", boundary = "periodic" }
temperature = { bulk = "100 °C" }
acceleration = { max_wear = "20 nm", tolerance = 0.5 }
[friction]
coefficient = 0.4
force = "6 mN"
increments = 2
[[history]]
force = "-6 mN"
increments = 2
cycles = 400
period = "50 ms"
[[history]]
load = "20 mN"
increments = 2
"#;

/// A ball of steel on a flat body of it.
fn ball(in_plane: &str, history: &str, coefficient: &str) -> String {
    format!(
        r#"
lower = {{ young = "210 GPa", poisson = 0.3, topography = {{ form = "flat", shape = [48, 48], pitch = "5 um" }}, wear = {{ coefficient = "{coefficient}" }} }}
upper = {{ young = "210 GPa", poisson = 0.3, topography = {{ form = "sphere", radius = "5 mm" }} }}
contact = {{ load = "10 N" }}
friction = {{ coefficient = 0.5, {in_plane}, increments = 4 }}
acceleration = {{ max_wear = "1 um" }}
[[history]]
{history}
increments = 4
"#
    )
}

fn solved(text: &str) -> StaticResult {
    at_rest(&parsed(text))
}

#[test]
fn bodies_that_attract_each_other_fret_and_go_on_with_the_same_bits() {
    let attracting = ROUGH.replace("young = \"70 GPa\", poisson = 0.2", "young = \"210 GPa\", poisson = 0.3");
    let attracting = attracting
        .replace("temperature =", "adhesion = { work = \"1 J/m2\", range = \"2 nm\" }\ntemperature =");
    goes_on(&parsed(&attracting.replace("cycles = 400", "cycles = 30")));
}

/// Films grow faster where friction heats them.
#[test]
fn bodies_that_warm_up_as_they_fret_go_on_after_interruptions_with_the_same_bits() {
    let heat =
        "conductivity = \"5 W/(m K)\", heat_capacity = \"460 J/(kg K)\", density = \"7850 kg/m3\", young";
    let warm = ROUGH.replace("young", heat).replace("cycles = 400", "cycles = 40").replace("50 ms", "10 ns");
    let last = |increments: Vec<IncrementRecord>| increments.last().cloned().unwrap();
    let cold = last(solved(&warm.replace("bulk", "every = 0, bulk")).increments);
    let warm = last(goes_on(&parsed(&warm)).results.increments().unwrap());
    let heat = warm.heat.unwrap();
    assert!(heat.max_flash_temperature > 375.0 && cold.heat.is_none(), "{heat:?}");
    let [warm, cold] = [warm, cold].map(|each| each.fretting.unwrap().laws.max_film_lower);
    assert!(warm > 1.001 * cold, "{warm:e} {cold:e}");
}

#[test]
fn rough_bodies_fret_and_go_on_with_the_same_bits_on_any_number_of_threads() {
    let whole = goes_on(&parsed(ROUGH));
    let increments = whole.results.increments().unwrap();
    let fretting = increments.last().unwrap().fretting.unwrap();
    assert!(fretting.cycles == 400 && increments.len() < 4 * 400, "{fretting:?}");
    assert!(fretting.laws.worn_volume_lower > 0.0 && fretting.laws.worn_volume_upper > 0.0, "{fretting:?}");
    assert!(fretting.laws.max_film_lower > 0.0 && fretting.laws.max_film_upper == 0.0, "{fretting:?}");
    // The worn bodies are those of the fields.
    let worn = 1e-12 * written(&whole.results, "wear_upper").sum();
    assert!((worn / fretting.laws.worn_volume_upper - 1.0).abs() < 1e-12);
}

#[test]
fn partial_slip_wears_the_annulus_alone_and_gross_slip_everywhere() {
    let pushed = solved(&ball("force = \"3.5 N\"", "force = \"-3.5 N\"\ncycles = 2000", "1e-5 mm3/(N m)"));
    let scar = field(&pushed, "wear_lower");
    let stick = field(&pushed, "stick");
    let deepest = most(scar);
    assert!(deepest > 1e-9 && scar[[24, 24]] == 0.0 && stick[[24, 24]] == 1.0, "{deepest}");
    let shifted =
        solved(&ball("displacement = \"5 um\"", "displacement = \"-5 um\"\ncycles = 2000", "1e-5 mm3/(N m)"));
    let scar = field(&shifted, "wear_lower");
    assert!(scar[[24, 24]] > 0.9 * most(scar));
    // The scar flattens the contact, and its volume is k W times the path of the slip.
    let [first, last] = [&shifted.increments[3], shifted.increments.last().unwrap()];
    assert!(last.max_pressure < 0.9 * first.max_pressure && last.contact_area > 1.1 * first.contact_area);
    let of_energy = |record: &IncrementRecord| {
        let fretting = record.fretting.unwrap();
        1e-14 / 0.5 * fretting.friction_work / fretting.laws.worn_volume_lower
    };
    assert!((of_energy(last) - 1.0).abs() < 5e-3, "{}", of_energy(last));
}

#[test]
fn scar_and_loop_change_together_over_ten_thousand_cycles() {
    let text = ball("force = \"4 N\"", "force = \"-4 N\"\ncycles = 10000", "1e-4 mm3/(N m)");
    let result = solved(&text);
    let ends: Vec<&IncrementRecord> = result
        .increments
        .windows(2)
        .filter(|pair| pair[0].fretting.unwrap().cycles != pair[1].fretting.unwrap().cycles)
        .map(|pair| &pair[1])
        .collect();
    let (first, last) = (ends[0], ends[ends.len() - 1]);
    assert_eq!(last.fretting.unwrap().cycles, 10_000);
    assert!(ends.len() < 60, "{}", ends.len());
    // The stuck middle bears more and more of the load, and the bodies shift further.
    assert!(last.max_pressure > 1.01 * first.max_pressure);
    assert!(last.tangential_displacement_x > 1.01 * first.tangential_displacement_x);
    // A tenth of the tolerance gives the same scar, within the estimate of the error.
    let finer = solved(&text.replace("max_wear = \"1 um\"", "max_wear = \"1 um\", tolerance = 0.001"));
    let [one, other] = [&result, &finer].map(|result| most(field(result, "wear_lower")));
    let difference = (one / other - 1.0).abs();
    assert!(difference < 0.01, "{difference}");
}

#[test]
fn cycles_without_wear_repeat_the_loop() {
    let text = ball("force = \"4 N\"", "force = \"-4 N\"\ncycles = 3", "1e-6 mm3/(N m)");
    let plain = text
        .replace(", wear = { coefficient = \"1e-6 mm3/(N m)\" }", "")
        .replace("acceleration = { max_wear = \"1 um\" }\n", "");
    let result = solved(&plain);
    assert_eq!(result.increments.len(), 4 + 3 * 8);
    assert!(result.increments.iter().all(|increment| increment.fretting.is_none()));
    let displacement = |index: usize| result.increments[index].tangential_displacement_x;
    for step in 0..8 {
        let most = displacement(3);
        let difference = (displacement(12 + step) - displacement(20 + step)).abs() / most;
        assert!(difference < 1e-3, "{step}: {difference}");
    }
}

#[test]
fn cycles_on_surfaces_that_have_yielded_wear_as_their_ways_one_by_one() {
    // Under a third of the load that flattened it, the ball bears on the surface that it has left.
    let ball = ball("force = \"0 N\"", "load = \"3 N\"", "1e-10 mm3/(N m)");
    let ball = ball.replace("poisson = 0.3", "poisson = 0.3, hardness = \"0.6 GPa\"");
    let way =
        |force: &str, cycles: &str| format!("[[history]]\nforce = \"{force}\"\nincrements = 8\n{cycles}");
    let [there, back] = [way("0.9 N", ""), way("-0.9 N", "")];
    let cyclic = solved(&format!("{ball}{there}{}", way("-0.9 N", "cycles = 3\n")));
    let single = solved(&format!("{ball}{there}{}", [back, there.clone()].concat().repeat(3)));
    assert!(single.increments.iter().any(|increment| increment.plastic_volume > 0.0));
    let [one, other] = [&cyclic, &single].map(|result| field(result, "wear_lower"));
    let (deepest, difference) = (most(other), most(&(one - other).mapv(f64::abs)));
    assert!(deepest > 0.0 && difference < 1e-6 * deepest, "{}", difference / deepest);
}

#[test]
fn cycles_that_are_slow_for_the_heat_of_a_warm_spot_say_so() {
    let heat =
        "conductivity = \"15 W/(m K)\", heat_capacity = \"460 J/(kg K)\", density = \"7850 kg/m3\", young";
    let of = |displacement: &str, period: &str| {
        let there = format!("displacement = \"{displacement}\"");
        let back = format!("displacement = \"-{displacement}\"\ncycles = 1\nperiod = \"{period}\"");
        let text = ball(&there, &back, "1e-9 mm3/(N m)").replace("young", heat);
        let text = text.replace("\nfriction =", "\ntemperature = { bulk = \"20 °C\" }\nfriction =");
        let result = solved(&text);
        let last = result.increments.last().unwrap().heat.unwrap().max_flash_temperature;
        (
            last - 293.15,
            result.warnings.iter().any(|warning| warning.contains("follows the slip within the cycle")),
        )
    };
    let (slow, fast, cool) = (of("10 um", "1.5 ms"), of("10 um", "150 us"), of("10 um", "1 s"));
    assert!(slow.0 > 10.0 && slow.1, "{slow:?}");
    assert!((fast.0 / slow.0 - 10.0).abs() < 1e-6 && !fast.1, "{fast:?}");
    assert!(cool.0 < 10.0 && !cool.1, "{cool:?}");
}
