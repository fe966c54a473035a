# The two commands of a fresh machine are `make run` and `make test`; the others are for daily work.
# Each first makes sure of cmake and libclang (tools/ensure-native.sh), which SUNDIALS' bindings need.

.PHONY: run test bench lint doc clean native

# A steady-state trim of the bundled motorcycle: 30 m/s, leaned by 35 degrees.
run: native
	cargo run --release -- trim gsxr1000 --speed 30 --lean 35deg

test: native
	cargo test --workspace

bench: native
	cargo bench --workspace

lint: native
	cargo fmt --all --check
	cargo clippy --workspace --all-targets -- -D warnings

doc: native
	RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps

clean:
	cargo clean

native:
	@sh tools/ensure-native.sh
