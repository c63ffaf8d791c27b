/* Serial port over USB: descriptors for TinyUSB. Its driver is polled instead of using interrupts. */
#include "board.h"
#include "pins.h"
#include "chip.h"
#include "tusb.h"

enum { INTERFACE_CONTROL, INTERFACE_DATA, INTERFACES };
enum { TEXT_LANGUAGE, TEXT_MAKER, TEXT_PRODUCT, TEXT_SERIAL, TEXTS };
enum { ENDPOINT_NOTIFY = 0x81, ENDPOINT_OUT = 0x02, ENDPOINT_IN = 0x82, TEXT_UNITS = 24 };

/* vendor and product from the test range of pid.codes, since this is not a commercial product */
static const tusb_desc_device_t device = {
    .bLength = sizeof(tusb_desc_device_t),
    .bDescriptorType = TUSB_DESC_DEVICE,
    .bcdUSB = 0x0200,
    .bDeviceClass = TUSB_CLASS_MISC,
    .bDeviceSubClass = MISC_SUBCLASS_COMMON,
    .bDeviceProtocol = MISC_PROTOCOL_IAD,
    .bMaxPacketSize0 = CFG_TUD_ENDPOINT0_SIZE,
    .idVendor = 0x1209,
    .idProduct = 0x0001,
    .bcdDevice = 0x0100,
    .iManufacturer = TEXT_MAKER,
    .iProduct = TEXT_PRODUCT,
    .iSerialNumber = TEXT_SERIAL,
    .bNumConfigurations = 1,
};

static const uint8_t configuration[] = {
    TUD_CONFIG_DESCRIPTOR(1, INTERFACES, 0, TUD_CONFIG_DESC_LEN + TUD_CDC_DESC_LEN, 0, 100),
    TUD_CDC_DESCRIPTOR(INTERFACE_CONTROL, 0, ENDPOINT_NOTIFY, 8, ENDPOINT_OUT, ENDPOINT_IN, 64),
};

const uint8_t *tud_descriptor_device_cb(void)
{
    return (const uint8_t *)&device;
}

const uint8_t *tud_descriptor_configuration_cb(uint8_t index)
{
    (void)index;
    return configuration;
}

uint32_t board_serial(void)
{
    return NVM_SERIAL;
}

static void serial_text(char *text)
{
    uint32_t serial = board_serial();
    for (int i = 0; i < 8; i++) text[i] = "0123456789ABCDEF"[(serial >> (28 - 4 * i)) & 15u];
    text[8] = 0;
}

const uint16_t *tud_descriptor_string_cb(uint8_t index, uint16_t language)
{
    static uint16_t units[1 + TEXT_UNITS];
    static char serial[9];
    static const char *const texts[TEXTS] = {"\x09\x04", "fdvv", "fdvv button simulator", serial};
    (void)language;
    if (index >= TEXTS) return 0;
    unsigned count = 0;
    if (index == TEXT_LANGUAGE) {
        units[1] = 0x0409; /* English */
        count = 1;
    } else {
        serial_text(serial);
        for (; texts[index][count] && count < TEXT_UNITS; count++) units[1 + count] = (uint8_t)texts[index][count];
    }
    units[0] = (uint16_t)((TUSB_DESC_STRING << 8) | (2 * count + 2));
    return units;
}

/* TinyUSB uses this only for a remote wake-up, which this board never requests. */
uint32_t tusb_time_millis_api(void)
{
    return board_now_us() / 1000;
}

void board_usb_start(void)
{
    board_clock(GCLK_ID_USB, USB_GENERATOR);
    board_pin(PIN_USB_MINUS, USB_MUX);
    board_pin(PIN_USB_PLUS, USB_MUX);
    const tusb_rhport_init_t port = {.role = TUSB_ROLE_DEVICE, .speed = TUSB_SPEED_FULL};
    tusb_init(0, &port);
}

void board_usb_step(void)
{
    tud_int_handler(0);
    tud_task();
    tud_cdc_write_flush();
}

uint8_t board_usb_open(void)
{
    return tud_cdc_connected();
}

uint16_t board_usb_room(void)
{
    return (uint16_t)tud_cdc_write_available();
}

uint16_t board_usb_read(uint8_t *bytes, uint16_t room)
{
    return tud_cdc_available() ? (uint16_t)tud_cdc_read(bytes, room) : 0;
}

uint16_t board_usb_write(const uint8_t *bytes, uint16_t count)
{
    return (uint16_t)tud_cdc_write(bytes, count);
}
