/** The studio's page. */

import { mount } from "svelte";
import { followAddress } from "./app/route";
import Shell from "./app/Shell.svelte";
import { followTheme } from "./app/theme";
import { live, seat } from "./net/live";
import { listenForShortcuts } from "./ui/keys";
import "./style.css";

followTheme();
followAddress();
listenForShortcuts();
live().open();
mount(Shell, { target: document.body });
// what runs is in view on every page of the studio; the page of a seat may not ask for it
if (!seat()) void import("./pages/live/list").then(({ showInHeader }) => showInHeader());
