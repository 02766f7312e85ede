//! Code density, and the register map for LiteX.

use tofsim::firmware::registers::map::{ALL, RING_ON};
use tofsim_board::csr::csr_csv;
use tofsim_rtl::golden::parameters::hash::parameters_hash;

use crate::client::{open, registers, setup};
use crate::device::{Device, Faults, Registers};

#[test]
fn the_code_density_is_what_the_ring_gave_and_the_ring_is_off_afterwards() {
    let setup = setup();
    let ring: Vec<u32> = (0..801).map(|n| u32::from(n < 700) * (n % 7)).collect();
    let running = Registers { ring: ring.clone(), ..registers(&setup) };
    let device = Device::on_terminal(running, Faults::default());
    let mut board = open(&device, &setup, false).unwrap();
    let mut told = Vec::new();
    let counts = board.code_density(&setup, 20_000, None, &mut |now| told.push(now)).unwrap();
    let (total, once) = (counts.iter().sum::<u64>(), ring.iter().sum::<u32>());
    assert!(total >= 20_000 && total % u64::from(once) == 0, "{total} of {once}");
    let times = total / u64::from(once);
    assert!(counts.iter().zip(&ring).all(|(count, hits)| *count == times * u64::from(*hits)));
    assert!(told.is_sorted() && told.last() == Some(&20_000), "{told:?}");
    assert_eq!(RING_ON.of(device.state().registers.control), 0);
}

#[test]
fn a_ring_that_gives_no_hits_is_an_error() {
    let setup = setup();
    let device = Device::on_terminal(registers(&setup), Faults::default());
    let mut board = open(&device, &setup, false).unwrap();
    let error = board.code_density(&setup, 1000, None, &mut |_| {}).unwrap_err().to_string();
    let expected = "density_hits = 0: expected 1000: the ring gave no hit for 0.15 s";
    assert_eq!(error, format!("{}: {expected}", device.port));
    assert_eq!(RING_ON.of(device.state().registers.control), 0);
}

#[test]
fn csr_csv_has_every_register_in_bytes_and_the_constants_that_litex_needs() {
    let setup = setup();
    let text = csr_csv(&setup);
    let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
    assert!(rows.iter().all(|row| row.len() == 5), "{text}");
    let of = |group: &str| rows.iter().filter(move |row| row[0] == group).collect::<Vec<_>>();
    assert_eq!(of("csr_register").len(), ALL.len());
    for line in [
        "csr_register,identity,0x00000000,1,ro",
        "csr_register,parameters_hash,0x00000008,2,ro",
        "csr_register,arm,0x00000028,1,rw",
        "csr_register,depth,0x00000068,2,ro",
        "constant,config_csr_data_width,32,,",
        "constant,config_bus_address_width,32,,",
        "constant,config_clock_frequency,125000000,,",
        "memory_region,histogram,0x00004000,1024,io",
        "memory_region,code_density,0x00008000,3204,io",
        &format!("constant,parameters_hash_value,{},,", parameters_hash(&setup)),
    ] {
        assert!(text.lines().any(|own| own == line), "{line} is not in\n{text}");
    }
}
