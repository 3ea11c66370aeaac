#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| asperity_fuzz::netcdf(data));
