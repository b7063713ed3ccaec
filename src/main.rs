//! Starts the command line, nothing else.

fn main() -> std::process::ExitCode {
    trackbed::cli::main()
}
