//! A file that is added is embedded, too.

fn main() {
    for folder in ["modules", "shell", "style", "vendor"] {
        println!("cargo:rerun-if-changed={folder}");
    }
}
