//! Prints what `src/golden.txt` should say: `cargo run --release -p starball-shared --example golden > shared/src/golden.txt`

fn main() {
    print!("{}", shared::golden::file());
}
