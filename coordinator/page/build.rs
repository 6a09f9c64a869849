//! Embeds the files of the page, including new ones.

fn main() {
    for folder in ["modules", "shell", "style", "vendor"] {
        println!("cargo:rerun-if-changed={folder}");
    }
}
