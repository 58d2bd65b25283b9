"""The pages of azee, built by Vite into `dist`; azee/web/README.md says how."""
