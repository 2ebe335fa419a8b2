// SPDX-License-Identifier: GPL-2.0
/*
 * traction_adc - the emulated board's converters: one IIO device whose counts come from the plant.
 *
 * Read as any other: in_accel_x_raw and its like at any time, in_voltage0 (the radar) through the kernel's FIFO with time stamps, as a
 * converter with a hardware FIFO hands them over. Fed through /dev/traction-adc with records of struct traction_adc_value.
 */
#include <linux/fs.h>
#include <linux/iio/buffer.h>
#include <linux/iio/iio.h>
#include <linux/iio/kfifo_buf.h>
#include <linux/init.h>
#include <linux/miscdevice.h>
#include <linux/module.h>
#include <linux/mutex.h>
#include <linux/platform_device.h>
#include <linux/uaccess.h>

enum { RADAR, BATTERY, ACCEL_X, ACCEL_Y, ACCEL_Z, GYRO_X, GYRO_Y, GYRO_Z, CHANNELS };

struct traction_adc_value {
	__u32 channel;
	__s32 value;
	__s64 stamp_ns; /* of a radar sample, on CLOCK_REALTIME or any other that does not jump */
};

struct traction_adc {
	struct mutex lock;
	int value[CHANNELS];
	int rate_Hz;
	bool capturing;
	struct {
		u16 count;
		s64 stamp __aligned(8);
	} scan;
};

static struct iio_dev *the_device;

#define RAW(kind, number, axis, place)                                                                                      \
	{                                                                                                                   \
		.type = (kind), .indexed = (kind) == IIO_VOLTAGE, .channel = (number), .modified = (kind) != IIO_VOLTAGE,    \
		.channel2 = (axis), .address = (place), .info_mask_separate = BIT(IIO_CHAN_INFO_RAW), .scan_index = -1,      \
	}

static const struct iio_chan_spec traction_adc_channels[] = {
	{
		.type = IIO_VOLTAGE,
		.indexed = 1,
		.channel = 0,
		.address = RADAR,
		.info_mask_separate = BIT(IIO_CHAN_INFO_RAW),
		.info_mask_shared_by_all = BIT(IIO_CHAN_INFO_SAMP_FREQ),
		.scan_index = 0,
		.scan_type = { .sign = 'u', .realbits = 10, .storagebits = 16, .endianness = IIO_LE },
	},
	RAW(IIO_VOLTAGE, 1, 0, BATTERY),
	RAW(IIO_ACCEL, 0, IIO_MOD_X, ACCEL_X),
	RAW(IIO_ACCEL, 0, IIO_MOD_Y, ACCEL_Y),
	RAW(IIO_ACCEL, 0, IIO_MOD_Z, ACCEL_Z),
	RAW(IIO_ANGL_VEL, 0, IIO_MOD_X, GYRO_X),
	RAW(IIO_ANGL_VEL, 0, IIO_MOD_Y, GYRO_Y),
	RAW(IIO_ANGL_VEL, 0, IIO_MOD_Z, GYRO_Z),
	IIO_CHAN_SOFT_TIMESTAMP(1),
};

static int traction_adc_read_raw(struct iio_dev *device, struct iio_chan_spec const *channel, int *value, int *value2, long mask)
{
	struct traction_adc *adc = iio_priv(device);

	if (mask != IIO_CHAN_INFO_RAW && mask != IIO_CHAN_INFO_SAMP_FREQ)
		return -EINVAL;
	mutex_lock(&adc->lock);
	*value = mask == IIO_CHAN_INFO_RAW ? adc->value[channel->address] : adc->rate_Hz;
	mutex_unlock(&adc->lock);
	return IIO_VAL_INT;
}

static int traction_adc_write_raw(struct iio_dev *device, struct iio_chan_spec const *channel, int value, int value2, long mask)
{
	struct traction_adc *adc = iio_priv(device);

	if (mask != IIO_CHAN_INFO_SAMP_FREQ || value <= 0 || value2 != 0)
		return -EINVAL;
	mutex_lock(&adc->lock);
	adc->rate_Hz = value;
	mutex_unlock(&adc->lock);
	return 0;
}

static const struct iio_info traction_adc_info = {
	.read_raw = traction_adc_read_raw,
	.write_raw = traction_adc_write_raw,
};

static int traction_adc_capture(struct iio_dev *device, bool on)
{
	struct traction_adc *adc = iio_priv(device);

	mutex_lock(&adc->lock);
	adc->capturing = on;
	mutex_unlock(&adc->lock);
	return 0;
}

static int traction_adc_postenable(struct iio_dev *device) { return traction_adc_capture(device, true); }
static int traction_adc_predisable(struct iio_dev *device) { return traction_adc_capture(device, false); }

static const struct iio_buffer_setup_ops traction_adc_buffer_ops = {
	.postenable = traction_adc_postenable,
	.predisable = traction_adc_predisable,
};

static ssize_t traction_adc_feed(struct file *file, const char __user *from, size_t size, loff_t *place)
{
	struct traction_adc *adc = iio_priv(the_device);
	struct traction_adc_value in;
	size_t done;

	for (done = 0; done + sizeof(in) <= size; done += sizeof(in)) {
		if (copy_from_user(&in, from + done, sizeof(in)))
			return -EFAULT;
		if (in.channel >= CHANNELS)
			return -EINVAL;
		mutex_lock(&adc->lock);
		adc->value[in.channel] = in.value;
		if (in.channel == RADAR && adc->capturing) {
			adc->scan.count = in.value;
			iio_push_to_buffers_with_timestamp(the_device, &adc->scan, in.stamp_ns);
		}
		mutex_unlock(&adc->lock);
	}
	return done;
}

static const struct file_operations traction_adc_files = {
	.owner = THIS_MODULE,
	.write = traction_adc_feed,
};

static struct miscdevice traction_adc_misc = {
	.minor = MISC_DYNAMIC_MINOR,
	.name = "traction-adc",
	.fops = &traction_adc_files,
};

static int traction_adc_probe(struct platform_device *platform)
{
	struct iio_dev *device = devm_iio_device_alloc(&platform->dev, sizeof(struct traction_adc));
	struct traction_adc *adc;
	int result;

	if (!device)
		return -ENOMEM;
	adc = iio_priv(device);
	mutex_init(&adc->lock);
	adc->rate_Hz = 512;
	device->name = "traction-adc";
	device->info = &traction_adc_info;
	device->channels = traction_adc_channels;
	device->num_channels = ARRAY_SIZE(traction_adc_channels);
	device->modes = INDIO_DIRECT_MODE;
	result = devm_iio_kfifo_buffer_setup(&platform->dev, device, &traction_adc_buffer_ops);
	if (result)
		return result;
	result = devm_iio_device_register(&platform->dev, device);
	if (result)
		return result;
	the_device = device;
	return misc_register(&traction_adc_misc);
}

static struct platform_driver traction_adc_driver = {
	.probe = traction_adc_probe,
	.driver = { .name = "traction-adc", .suppress_bind_attrs = true },
};

static int __init traction_adc_init(void)
{
	int result = platform_driver_register(&traction_adc_driver);

	if (result)
		return result;
	return PTR_ERR_OR_ZERO(platform_device_register_simple("traction-adc", -1, NULL, 0));
}
late_initcall(traction_adc_init);

MODULE_DESCRIPTION("The converters of Traction's emulated board");
MODULE_LICENSE("GPL");
